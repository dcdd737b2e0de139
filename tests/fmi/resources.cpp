// The files of an FMU without its zip.
#include <unistd.h>

#include "runtime/library/session.hpp"
#include "tests/fmi/functions.hpp"

namespace ipos::tests {

namespace fs = std::filesystem;

Resources::Resources(const std::string& plant, const std::string& program, fmi::Choice choice, const std::string& folder_name) {
  const auto* const test = ::testing::UnitTest::GetInstance()->current_test_info();
  above_ = fs::temp_directory_path() / ("ipos_fmi_" + std::string(test == nullptr ? "fuzz" : test->name()) + "_" +
                                        std::to_string(::getpid()) + "_" + std::to_string(reinterpret_cast<uintptr_t>(this)));
  folder_ = above_ / folder_name;
  fs::create_directories(folder_);
  package_.plant = plant;
  package_.choice = std::move(choice);
  const size_t stations = runtime::read_plant_file(plant).plant.stations.size();
  if (!package_.choice.line) package_.stations.resize(stations);
  if (!program.empty()) {
    compiler::CompileOptions options;
    options.unit = runtime::read_plant_file(plant).plant.stations.front().unit;
    package_.stations.front().program = compiler::compile("P.IPC", "P.IPC", program, options).image;
    EXPECT_TRUE(package_.stations.front().program);
  }
  for (const auto& [name, bytes] : fmi::files_of(package_, "test")) std::ofstream(folder_ / name, std::ios::binary) << bytes;
  auto contents = fmi::contents_of(package_);
  EXPECT_TRUE(contents) << (contents ? "" : contents.error());
  if (!contents) return;
  auto session = library::Session::open(*std::move(contents), true);
  session_ = *std::move(session);
  auto variables = fmi::variables_of(session_->plant(), package_.choice);
  EXPECT_TRUE(variables) << (variables ? "" : variables.error());
  variables_ = *std::move(variables);
}

Resources::~Resources() {
  std::error_code ignored;
  fs::remove_all(above_, ignored);
}

std::string Resources::uri() const {
  std::string out = "file://";
  for (const char c : folder())
    if (c == ' ')
      out += "%20";
    else
      out += c;
  return out;
}

uint32_t Resources::reference(const std::string& name) const {
  for (size_t n = 0; n < variables_.all.size(); ++n)
    if (variables_.all[n].name == name) return static_cast<uint32_t>(n + 1);
  ADD_FAILURE() << "no variable " << name;
  return UINT32_MAX;
}

void* Resources::make2(Told& told) const {
  const Fmi2Callbacks callbacks{Told::fmi2, nullptr, nullptr, nullptr, &told};
  return fmi2Instantiate("one", 1, token().c_str(), uri().c_str(), &callbacks, 0, 0);
}
void* Resources::make3(Told& told, bool events, bool early) const {
  return fmi3InstantiateCoSimulation("one", token().c_str(), folder().c_str(), false, false, events, early, nullptr, 0, &told,
                                     Told::fmi3, nullptr);
}

void* Resources::begin2(Told& told) const {
  void* made = make2(told);
  EXPECT_NE(made, nullptr) << told.text;
  EXPECT_EQ(fmi2SetupExperiment(made, 0, 0, 0, 0, 0), kOk);
  EXPECT_EQ(fmi2EnterInitializationMode(made), kOk);
  EXPECT_EQ(fmi2ExitInitializationMode(made), kOk);
  return made;
}
void* Resources::begin3(Told& told, bool events, bool early) const {
  void* made = make3(told, events, early);
  EXPECT_NE(made, nullptr) << told.text;
  EXPECT_EQ(fmi3EnterInitializationMode(made, false, 0, 0, false, 0), kOk);
  EXPECT_EQ(fmi3ExitInitializationMode(made), kOk);
  if (events) {
    EXPECT_EQ(fmi3EnterStepMode(made), kOk);
  }
  return made;
}

}  // namespace ipos::tests
