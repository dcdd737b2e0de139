// The files lie to each other as they do in the project, so that each finds what it names.
#include "tools/campaign/case_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "tools/campaign/machine.hpp"
#include "tools/cli/failure.hpp"
#include "tools/cli/files.hpp"
#include "tools/cli/os_file.hpp"
#include "tools/cli/outputs.hpp"
#include "tools/sessions/session.hpp"

namespace ipos::tools::campaign {

namespace fs = std::filesystem;

std::string write_case(const std::string& folder, const Campaign& campaign, const CompileFlags& compile, const Levels& levels) {
  Subject subject(campaign, compile);
  const bool is_test = !campaign.tests.empty();
  const std::string plant = is_test ? campaign.tests.front().plant_path : campaign.plant;
  const std::string opened = is_test ? campaign.tests.front().file : plant;
  std::vector<std::string> files{plant, opened};
  const Prepared& prepared = subject.prepared(levels);
  for (const runtime::StationConfig& station : is_test ? prepared.tests.front().plant.stations : prepared.plant.stations) {
    if (station.program.empty()) continue;
    files.push_back(beside(plant, station.program));
    if (!is_source(files.back())) continue;
    for (std::string& file : included_files(std::string(files.back()), compile)) files.push_back(std::move(file));
  }
  std::sort(files.begin(), files.end());
  files.erase(std::unique(files.begin(), files.end()), files.end());
  const std::string root = sessions::common_folder(files);
  const auto path_of = [&](const std::string& file) { return fs::path(folder) / sessions::name_in(root, file); };
  for (const std::string& file : files) {
    fs::create_directories(path_of(file).parent_path());
    rewrite_file(path_of(file).string(), file == plant ? subject.plant_text(levels) : read_file(file));
  }
  return path_of(opened).string();
}

int serve_case(const Campaign& campaign, const CompileFlags& compile, const Levels& levels, uint16_t port) {
  const auto folder = make_folder((fs::temp_directory_path() / "ipos-case-").string());
  if (!folder) throw Failure(kIoError, "no folder can be made for the case");
  return run_again({"serve", write_case(*folder, campaign, compile, levels), "--port", std::to_string(port)});
}

}  // namespace ipos::tools::campaign
