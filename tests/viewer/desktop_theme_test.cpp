#include "viewer/window/desktop_theme.h"

#include <gtest/gtest.h>

#include <string>

namespace kerf {
namespace {

/// Settings as a desktop writes them: a number, a colour, the theme.
class Xsettings {
 public:
  explicit Xsettings(bool is_high_first) : is_high_first_(is_high_first) {
    bytes_ += is_high_first ? '\1' : '\0';
    bytes_.append(3, '\0');
    number(7, 4);  // serial
    number(3, 4);
    head(0, "Xft/DPI");
    number(98304, 4);
    head(2, "Net/Colour");
    for (int i = 0; i < 4; ++i) number(0xffff, 2);
  }
  std::string with_theme(const std::string& name) {
    head(1, "Net/ThemeName");
    number(name.size(), 4);
    text(name);
    return bytes_;
  }

 private:
  void head(int type, const std::string& name) {
    bytes_ += static_cast<char>(type);
    bytes_ += '\0';
    number(name.size(), 2);
    text(name);
    number(1, 4);  // serial
  }
  void number(std::size_t value, int size) {
    for (int i = 0; i < size; ++i) {
      const int shift = 8 * (is_high_first_ ? size - 1 - i : i);
      bytes_ += static_cast<char>(value >> shift & 0xff);
    }
  }
  void text(const std::string& text) {
    bytes_ += text;
    bytes_.append((4 - text.size() % 4) % 4, '\0');
  }
  bool is_high_first_;
  std::string bytes_;
};

TEST(DesktopTheme, NamesSayIt) {
  EXPECT_EQ(is_dark_theme("Adwaita-dark"), true);
  EXPECT_EQ(is_dark_theme("Adwaita:dark"), true);
  EXPECT_EQ(is_dark_theme("Yaru-Dark"), true);
  EXPECT_EQ(is_dark_theme("Adwaita"), false);
  EXPECT_EQ(is_dark_theme(""), std::nullopt);
}

TEST(DesktopTheme, SettingsOfTheXServerInBothByteOrders) {
  for (const bool is_high_first : {false, true}) {
    EXPECT_EQ(dark_by_xsettings(Xsettings(is_high_first).with_theme("Greybird-dark")), true);
    EXPECT_EQ(dark_by_xsettings(Xsettings(is_high_first).with_theme("Greybird")), false);
  }
}

TEST(DesktopTheme, SettingsThatAreCutOffSayNothing) {
  const std::string whole = Xsettings(false).with_theme("Greybird-dark");
  // The last 3 bytes fill the name up to a multiple of 4.
  for (std::size_t size = 0; size + 3 < whole.size(); ++size) {
    EXPECT_EQ(dark_by_xsettings(std::string_view(whole).substr(0, size)), std::nullopt) << size;
  }
  std::string wild = whole;
  wild[8] = wild[9] = wild[10] = wild[11] = '\xff';  // four thousand million settings
  EXPECT_EQ(dark_by_xsettings(wild), true);
  wild[12] = '\x63';  // of a kind that nobody knows
  EXPECT_EQ(dark_by_xsettings(wild), std::nullopt);
}

TEST(DesktopTheme, SettingsOfGtk) {
  EXPECT_EQ(dark_by_settings_ini("[Settings]\ngtk-theme-name = Adwaita-dark\n"), true);
  EXPECT_EQ(dark_by_settings_ini("gtk-theme-name=Adwaita\r\n"), false);
  EXPECT_EQ(dark_by_settings_ini("gtk-theme-name=Adwaita\n"
                                 "gtk-application-prefer-dark-theme=1"),
            true);
  EXPECT_EQ(dark_by_settings_ini("gtk-font-name=Sans 10\n"), std::nullopt);
  EXPECT_EQ(dark_by_settings_ini(""), std::nullopt);
}

}  // namespace
}  // namespace kerf
