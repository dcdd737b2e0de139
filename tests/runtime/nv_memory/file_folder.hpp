// A folder of its own for the file of a unit, which goes with the test.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <random>
#include <string>

namespace ipos::runtime {

class FileFolder : public ::testing::Test {
 protected:
  FileFolder() {
    do {
      folder_ = std::filesystem::temp_directory_path() / ("ipos-nv-" + std::to_string(std::random_device{}()));
    } while (!std::filesystem::create_directory(folder_));
    path_ = (folder_ / "unit1.nv").string();
  }
  ~FileFolder() override {
    std::filesystem::permissions(folder_, std::filesystem::perms::owner_all);
    std::filesystem::remove_all(folder_);
  }
  std::filesystem::path folder_;
  std::string path_;
};

}  // namespace ipos::runtime
