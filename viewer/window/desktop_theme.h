// viewer/window/desktop_theme.h - whether the desktop wants dark windows. For the sources of
// viewer/ only.
#pragma once

#include <optional>
#include <string_view>

namespace kerf {

/// The first that says something: the variable GTK_THEME; the settings that a desktop keeps at the
/// X server for its programs (XSETTINGS: Xfce, GNOME, MATE, Cinnamon); gtk-3.0/settings.ini in the
/// user's configuration. None: nobody says. Looks once, and is not told of changes. A window has
/// to be open.
std::optional<bool> desktop_is_dark();

/// By the name of a theme: "Adwaita-dark", "Adwaita:dark"; none if it is empty.
std::optional<bool> is_dark_theme(std::string_view name);
/// Of Net/ThemeName among the settings in the format of the XSETTINGS property; none: it is not
/// there, or the settings are cut off before it.
std::optional<bool> dark_by_xsettings(std::string_view bytes);
/// Of the lines of a settings.ini of GTK.
std::optional<bool> dark_by_settings_ini(std::string_view text);

}  // namespace kerf
