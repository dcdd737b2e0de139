// The debugger runs the test once more: it counts moments as the page does.
#include "tools/testing/failed_state.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "runtime/plant/trace_hash.hpp"
#include "tools/cli/failure.hpp"
#include "tools/cli/files.hpp"
#include "tools/debugger/debugger.hpp"
#include "tools/input/sources.hpp"
#include "tools/sessions/session.hpp"
#include "tools/test_file/read_tests.hpp"
#include "tools/testing/debugged_test.hpp"

namespace ipos::tools::testing {
namespace {

// Nobody looks on.
class Alone final : public debug::FrontEnd {
 public:
  debug::Json save() override { return nullptr; }
  void load(const debug::Json& /*state*/) override {}
  bool keep_going() override { return true; }
  void output(const std::string& /*text*/) override {}
};

// Of the test, its plant, the programs and what they include.
std::vector<std::string> files_of(const TestCase& test, const CompileFlags& compile) {
  std::vector<std::string> files{test.file, test.plant_path};
  for (const runtime::StationConfig& station : test.plant.stations) {
    if (station.program.empty()) continue;
    files.push_back(beside(test.plant_path, station.program));
    if (!is_source(files.back())) continue;
    for (std::string& file : included_files(std::string(files.back()), compile)) files.push_back(std::move(file));
  }
  std::sort(files.begin(), files.end());
  files.erase(std::unique(files.begin(), files.end()), files.end());
  return files;
}

std::string case_of(const TestCase& test) {
  const size_t slash = test.name.rfind('/');
  const bool is_only = read_tests(test.file).size() == 1;
  return is_only || slash == std::string::npos ? "" : test.name.substr(slash + 1);
}

}  // namespace

std::string failed_state(const TestCase& test, const CompileFlags& compile, const RunOptions& options, Time moment) {
  sessions::Session session;
  const std::vector<std::string> files = files_of(test, compile);
  const std::string folder = sessions::common_folder(files);
  const auto name = [&](const std::string& file) { return sessions::name_in(folder, file); };
  for (const std::string& file : files) session.texts[name(file)] = read_file(file);
  session.plant = name(test.plant_path);
  session.test = {name(test.file), case_of(test), options.seed, options.speed};

  Alone alone;
  debug::Debugger debugger(debugged_test(std::make_shared<const TestCase>(test), compile, options), alone, nullptr,
                           runtime::kNever);
  debug::Order order;
  order.motion = debug::Motion::ToTime;
  order.time = moment;
  // The end of all programs ends an order, too, once.
  for (int stops = 0; debugger.plant().now() < moment && stops < 2; ++stops) {
    const debug::Position before = debugger.position();
    debugger.run(order);
    if (debugger.position() != before) stops = 0;
  }
  session.moment = debugger.position();
  session.digest = runtime::state_digest(debugger.plant());
  return sessions::session_text(session);
}

}  // namespace ipos::tools::testing
