// A plant opened by the C functions, with a program of its own folder, and the calls that tests make most often. A call
// that fails without being expected to is a failure of the test.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "tests/harness/reach.hpp"
#include "tests/runtime/library/functions.hpp"

namespace ipos::tests {

// A folder that is there as long as this is.
class OwnFolder {
 public:
  OwnFolder() {
    const auto* const test = ::testing::UnitTest::GetInstance()->current_test_info();
    path_ = std::filesystem::temp_directory_path() /
            (std::string("ipos_library_") + test->test_suite_name() + "_" + test->name());
    std::filesystem::create_directories(path_);
  }
  OwnFolder(const OwnFolder&) = delete;
  OwnFolder& operator=(const OwnFolder&) = delete;
  ~OwnFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  std::string path(const std::string& name = "") const { return (path_ / name).string(); }
  void write(const std::string& name, const std::string& text) const { std::ofstream(path_ / name) << text; }

 private:
  std::filesystem::path path_;
};

class OpenedPlant {
 public:
  explicit OpenedPlant(const std::string& text, const std::string& program = "",
                       ipos_plant_source source = {}) {
    goes_through(kLibrary);
    folder.write("P.IPC", program);
    const std::string path = folder.path();
    source.text = text.c_str();
    source.folder = path.c_str();
    EXPECT_EQ(ipos_plant_open(&source, &plant), IPOS_PLANT_OK) << message();
  }
  OpenedPlant(const OpenedPlant&) = delete;
  OpenedPlant& operator=(const OpenedPlant&) = delete;
  ~OpenedPlant() { EXPECT_EQ(ipos_plant_close(plant), IPOS_PLANT_OK); }

  std::string message() const { return ipos_plant_message(plant); }
  void run(int64_t ms) const { EXPECT_EQ(ipos_plant_run(plant, ms * 1'000'000), IPOS_PLANT_OK) << message(); }
  uint32_t find(const char* name, ipos_plant_kind kind = IPOS_PLANT_ANY) const {
    uint32_t signal = UINT32_MAX;
    EXPECT_EQ(ipos_plant_find(plant, 0, kind, name, &signal), IPOS_PLANT_OK) << message();
    return signal;
  }
  int64_t value(uint32_t signal) const {
    int64_t read = 0;
    EXPECT_EQ(ipos_plant_read(plant, signal, &read), IPOS_PLANT_OK) << message();
    return read;
  }
  std::string text(uint32_t signal) const {
    const char* read = "";
    EXPECT_EQ(ipos_plant_read_text(plant, signal, &read), IPOS_PLANT_OK) << message();
    return read;
  }
  ipos_plant_signal_info info(uint32_t signal) const {
    ipos_plant_signal_info found{};
    EXPECT_EQ(ipos_plant_signal_info_of(plant, signal, &found), IPOS_PLANT_OK) << message();
    return found;
  }
  std::vector<std::string> names(ipos_plant_kind kind, const char* part = nullptr) const {
    std::vector<std::string> all;
    const char* name = nullptr;
    ipos_plant_status status = IPOS_PLANT_OK;
    while ((status = ipos_plant_name_at(plant, 0, kind, part, static_cast<uint32_t>(all.size()), &name)) ==
           IPOS_PLANT_OK)
      all.emplace_back(name);
    EXPECT_EQ(status, IPOS_PLANT_NOTHING);
    return all;
  }
  std::vector<ipos_plant_frame> frames(uint32_t bus = 0) const {
    std::vector<ipos_plant_frame> all(200);
    size_t count = 0;
    EXPECT_EQ(ipos_plant_receive(plant, bus, all.data(), all.size(), &count), IPOS_PLANT_OK) << message();
    all.resize(count);
    return all;
  }

  OwnFolder folder;
  ipos_plant* plant = nullptr;
};

}  // namespace ipos::tests
