// A drive that ipos has exported and the spring, stepped by a master of this test's own, against a plant of ipos that has the
// spring as its machine: the curves are the same.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "runtime/fmi_import/fmu_model.hpp"
#include "tests/fmi_import/folder.hpp"
#include "tests/harness/contains.hpp"

namespace ipos::tests {
namespace {

using runtime::MachineVariable;

class Stepped {
 public:
  Stepped(const std::filesystem::path& path, const std::string& input, const std::string& output) {
    std::ifstream file(path, std::ios::binary);
    auto model = fmi_import::read_fmu(std::string(std::istreambuf_iterator<char>(file), {}));
    EXPECT_TRUE(model) << path << (model ? "" : model.error());
    model_ = *model;
    const auto from = model_->find(input, MachineVariable::Role::Input), to = model_->find(output, MachineVariable::Role::Output);
    EXPECT_TRUE(from && to) << path << (from ? "" : from.error()) << (to ? "" : to.error());
    run_ = model_->make({"m", {from->number}, {to->number}, {}, 60'000'000'000});
  }
  void start() { check(run_->start({&in, 1}, {&out, 1})); }
  void step(int64_t ms) { check(run_->step(ms * 1'000'000, 1'000'000, {&in, 1}, {&out, 1})); }
  double in = 0;
  double out = 0;

 private:
  static void check(const runtime::MachineRun::Done& done) { ASSERT_TRUE(done) << done.error(); }
  std::shared_ptr<const runtime::MachineModel> model_;
  std::unique_ptr<runtime::MachineRun> run_;
};

// Like the plant the master lets the spring go through a millisecond first, then the drive has the new speed.
TEST(FmuBothWays, ImportAndExportGiveTheSameCurves) {
#ifdef IPOS_SANITIZED
  GTEST_SKIP() << "an FMU with a sanitizer in it does not load into the plain process that runs foreign FMUs";
#endif
  const FmuFolder folder;
  for (const int version : {2, 3}) {
    folder.write("p.toml", fmt::format(kDriven, fmt::format("spring{}.fmu", version)));
    const auto rows = traced(folder, "p.toml", "u.torque,u.shaft_speed", "1500ms");
    const std::string whole = read_text(folder.path() / "p.toml");
    folder.write("alone.toml", whole.substr(0, whole.find("[[machine]]")));
    const CommandResult made = folder.run({"fmu", "alone.toml", "-o", "drive.fmu", "--fmi", fmt::format("{}", version)});
    ASSERT_EQ(made.exit_code, 0) << made.err;
    Stepped spring(folder.path() / fmt::format("spring{}.fmu", version), "torque", "speed");
    Stepped drive(folder.path() / "drive.fmu", "u.shaft_speed", "u.torque");
    spring.start();
    drive.start();
    constexpr double kRpm = 60 / (2 * 3.14159265358979), kRated = 1500 / (1400 / kRpm);
    double furthest = 0;
    for (int64_t ms = 0; ms < 1400; ++ms) {
      spring.in = drive.out;
      spring.step(ms);
      drive.in = spring.out;
      drive.step(ms);
      const auto& row = rows[static_cast<size_t>(ms)];  // the first is of 1 ms
      ASSERT_EQ(row[0], static_cast<double>(ms + 1));
      EXPECT_NEAR(spring.out * kRpm, row[2], 0.002) << version << " " << ms;
      EXPECT_NEAR(drive.out, row[1] / 100 * kRated, 0.001) << version << " " << ms;
      furthest = std::max(furthest, spring.out * kRpm);
    }
    EXPECT_GT(furthest, 1000);
  }
}

// Nothing of the foreign FMU runs for it, and nobody is asked whether it may.
TEST(FmuBothWays, APlantWithAMachineIsRefusedAtItsLine) {
  const FmuFolder folder;
  folder.write_trouble(0);
  for (const std::vector<std::string>& more : {std::vector<std::string>{}, {"--fmi", "3"}}) {
    std::vector<std::string> words{"fmu", "p.toml", "-o", "p.fmu"};
    words.insert(words.end(), more.begin(), more.end());
    const CommandResult made = folder.run(words);
    EXPECT_EQ(made.exit_code, 65);
    EXPECT_TRUE(contains(made.err, "p.toml:4:1: a plant with foreign machines cannot become an FMU itself")) << made.err;
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "p.fmu"));
  }
}

}  // namespace
}  // namespace ipos::tests
