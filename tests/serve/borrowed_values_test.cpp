// What manual operation changes in a drive for a while: it is proved by reading, and written down before.
#include "tools/serve/borrowed_values.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <map>

#include "tools/serve/host/arguments.hpp"
#include "tools/serve/state_folder.hpp"

namespace ipos::tools::serve {
namespace {

namespace fs = std::filesystem;
using stdlib::Service;

constexpr uint16_t kTimeout = 8599, kSource = 8461;  // P812, P100

class Drive final : public ParameterAccess {
 public:
  AccessReply execute(Service service, uint16_t index, int32_t value) override {
    if (service == Service::Read) return values[index];
    EXPECT_EQ(service, Service::WriteVolatile) << "its memory is worn by the others";
    records_at_writes.push_back(records());
    if (takes) values[index] = value;
    if (!answers) return tl::unexpected(AccessError{{}, "no answer"});
    return value;
  }
  std::string name() const override { return "drive"; }
  const stdlib::UnitType& unit() const override { return *stdlib::find_unit("md60a"); }

  static size_t records() {
    size_t count = 0;
    for (const auto& entry : fs::directory_iterator(state_folder()))
      count += entry.path().filename().string().starts_with("borrowed-") ? 1 : 0;
    return count;
  }

  std::map<uint16_t, int32_t> values{{kTimeout, 0}, {kSource, 1}};
  bool takes = true;    // what is written
  bool answers = true;  // that it was
  std::vector<size_t> records_at_writes;
};

class BorrowedValuesTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "ipos-borrowed-XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    place_ = name;
    setenv("XDG_STATE_HOME", place_.c_str(), 1);
  }
  void TearDown() override {
    unsetenv("XDG_STATE_HOME");
    fs::remove_all(place_);
  }
  Drive drive_;

 private:
  fs::path place_;
};

TEST_F(BorrowedValuesTest, AreWrittenDownBeforeTheDriveIsAsked) {
  BorrowedValues values(drive_, "port", 1);
  values.set(kTimeout, 400);
  EXPECT_EQ(drive_.values[kTimeout], 400);
  EXPECT_EQ(drive_.records_at_writes, std::vector<size_t>{1});
  EXPECT_TRUE(values.give_back());
  EXPECT_EQ(drive_.values[kTimeout], 0);
  EXPECT_EQ(Drive::records(), 0U);
}

TEST_F(BorrowedValuesTest, AreGivenBackByTheNextStart) {
  BorrowedValues(drive_, "port", 1).set(kTimeout, 400);  // and killed
  EXPECT_TRUE(BorrowedValues(drive_, "port", 2).empty()) << "of another drive";
  BorrowedValues next(drive_, "port", 1);
  ASSERT_EQ(next.texts().size(), 1U);
  EXPECT_NE(next.texts()[0].find("0.400 s in place of 0.000 s"), std::string::npos) << next.texts()[0];
  EXPECT_TRUE(next.give_back());
  EXPECT_EQ(drive_.values[kTimeout], 0);
}

TEST_F(BorrowedValuesTest, OfAnOlderStartAreTheUsersWhereHeHasSetThemSince) {
  BorrowedValues(drive_, "port", 1).set(kTimeout, 400);
  drive_.values[kTimeout] = 300;
  EXPECT_TRUE(BorrowedValues(drive_, "port", 1).empty());
  EXPECT_EQ(Drive::records(), 0U);
}

// The answer to a write may be a late one to an earlier write of the same parameter.
TEST_F(BorrowedValuesTest, AreProvedByReading) {
  BorrowedValues values(drive_, "port", 1);
  drive_.takes = false;
  EXPECT_THROW(values.set(kTimeout, 400), Mistake);
  EXPECT_EQ(values.texts().size(), 1U) << "it may still come";
  drive_.takes = true;
  values.set(kSource, 2);
  drive_.takes = false;
  EXPECT_FALSE(values.give_back());
  ASSERT_EQ(values.texts().size(), 1U);
  EXPECT_NE(values.texts()[0].find("has not taken it back"), std::string::npos) << values.texts()[0];
  EXPECT_EQ(Drive::records(), 1U);
  drive_.takes = true;
  EXPECT_TRUE(values.give_back());
  EXPECT_EQ(drive_.values[kSource], 1);
}

TEST_F(BorrowedValuesTest, StayBorrowedWhereAWriteIsNotAnswered) {
  BorrowedValues values(drive_, "port", 1);
  drive_.answers = false;
  EXPECT_THROW(values.set(kTimeout, 400), Mistake);
  EXPECT_FALSE(values.give_back());
  EXPECT_EQ(Drive::records(), 1U);
  drive_.answers = true;
  EXPECT_TRUE(values.give_back());
  EXPECT_EQ(drive_.values[kTimeout], 0);
}

}  // namespace
}  // namespace ipos::tools::serve
