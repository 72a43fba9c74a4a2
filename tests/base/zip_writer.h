// tests/base/zip_writer.h - zip files for tests.
#pragma once

#include <gtest/gtest.h>
#include <zip.h>

#include <string>
#include <utility>
#include <vector>

#include "base/small_file.h"
#include "tests/base/temporary_folder.h"

namespace kerf {

/// The bytes of a zip file with members {name, text}.
inline std::string zipped(const std::vector<std::pair<std::string, std::string>>& members) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.zip";
  zip_t* const archive = zip_open(path.c_str(), ZIP_CREATE, nullptr);
  for (const auto& [name, text] : members) {
    zip_source_t* const source = zip_source_buffer(archive, text.data(), text.size(), 0);
    EXPECT_GE(zip_file_add(archive, name.c_str(), source, 0), 0);
  }
  EXPECT_EQ(zip_close(archive), 0);
  return read_small_file(path, std::size_t{1} << 28U).value();
}

}  // namespace kerf
