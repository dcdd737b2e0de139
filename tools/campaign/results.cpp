// What is wrong with results is told with the files it is in.
#include "tools/campaign/results.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <unordered_map>

#include "tools/campaign/shard_file.hpp"
#include "tools/cli/failure.hpp"
#include "tools/cli/files.hpp"
#include "tools/cli/outputs.hpp"

namespace ipos::tools::campaign {
namespace {

namespace fs = std::filesystem;

struct FoundOutline {
  std::string path;
  Outline outline;
};

std::vector<FoundOutline> outlines_in(const std::vector<std::string>& folders) {
  std::vector<FoundOutline> found;
  for (const std::string& folder : folders) {
    if (!is_folder(folder)) throw Failure(kNoInput, fmt::format("{}: there is no such folder of results", folder));
    const size_t before = found.size();
    std::vector<std::string> names = list_files(folder);
    std::sort(names.begin(), names.end());
    for (const std::string& name : names) {
      if (!name.starts_with("plan-") || !name.ends_with(".json")) continue;
      const std::string path = (fs::path(folder) / name).string();
      auto outline = read_outline(read_file(path));
      if (!outline) throw Failure(kBadInput, fmt::format("{}: this is no plan of a campaign", path));
      found.push_back({path, *std::move(outline)});
    }
    if (found.size() == before) throw Failure(kNoInput, fmt::format("{}: there are no results of a campaign", folder));
  }
  return found;
}

// Which of the files of a campaign are not the same.
std::string difference(const Outline& one, const Outline& other) {
  if (one.campaign != other.campaign) return fmt::format("{} and {}", one.campaign, other.campaign);
  if (one.version != other.version) return fmt::format("ipos {} and {}", one.version, other.version);
  for (const auto& [file, identity] : one.inputs)
    if (const auto same = other.inputs.find(file); same == other.inputs.end() || same->second != identity) return fmt::format("{} has changed", file);
  for (const auto& [file, identity] : other.inputs)
    if (!one.inputs.contains(file)) return fmt::format("{} has come", file);
  return fmt::format("{} has changed", one.campaign);
}

// All must be the same one.
Outline the_outline(std::vector<FoundOutline> found) {
  const std::string first = outline_json(found.front().outline);
  for (const FoundOutline& one : found)
    if (outline_json(one.outline) != first)
      throw Failure(kBadInput, fmt::format("these results are a mixture, {} and {}: {}; each needs a folder of its own", found.front().path, one.path,
                                           difference(found.front().outline, one.outline)));
  return std::move(found.front().outline);
}

class Reader {
 public:
  explicit Reader(Outline outline) {
    results_.outline = std::move(outline);
    const Plan plan(results_.outline);
    results_.rows.resize(plan.size());
    results_.levels.resize(plan.size());
    results_.there.resize(plan.size());
    from_.resize(plan.size());
    ranks_.reserve(plan.size());
    for (uint64_t rank = 0; rank < plan.size(); ++rank) {
      results_.rows[rank].id = plan.case_at(rank);
      plan.levels(rank, results_.levels[rank]);
      ranks_[plan.case_at(rank)] = rank;
    }
  }

  void read(const std::string& path) {
    files_.push_back(path);
    const std::string text = read_results_file(path);
    size_t line = 1;
    for (size_t begin = 0; begin < text.size(); ++line) {
      const size_t end = text.find('\n', begin);
      if (end == std::string::npos) {
        complain(fmt::format("{}:{}: the last line is not whole", path, line));
        break;
      }
      take(std::string_view(text).substr(begin, end - begin), fmt::format("{}:{}", path, line));
      begin = end + 1;
    }
  }

  Results finish(const std::vector<std::string>& folders) {
    const auto missing = static_cast<uint64_t>(std::count(results_.there.begin(), results_.there.end(), false));
    if (doubles_ != 0)
      complain(fmt::format("{} case{} double, with equal results: {} is the first", doubles_, doubles_ == 1 ? " is" : "s are", first_double_));
    if (missing != 0) {
      const auto rank = static_cast<uint64_t>(std::find(results_.there.begin(), results_.there.end(), false) - results_.there.begin());
      complain(fmt::format("{} of {} cases are missing, {} is the first; `ipos campaign run {} --out {}` runs them", missing, results_.rows.size(),
                           hex(results_.rows[rank].id), results_.outline.campaign, folders.front()));
    }
    return std::move(results_);
  }

 private:
  void take(std::string_view line, const std::string& place) {
    auto row = read_row(results_.outline, line);
    if (!row) throw Failure(kBadInput, fmt::format("{}: this is no result of this campaign", place));
    const auto rank = ranks_.find(row->id);
    if (rank == ranks_.end())
      throw Failure(kBadInput, fmt::format("{}: these results are a mixture: case {} is not of this plan; each state of {} needs a folder of its own",
                                           place, hex(row->id), results_.outline.campaign));
    const uint64_t at = rank->second;
    if (!results_.there[at]) {
      results_.there[at] = true;
      results_.rows[at] = *std::move(row);
      from_[at] = static_cast<uint32_t>(files_.size() - 1);
      return;
    }
    if (!(results_.rows[at] == *row))
      throw Failure(kBadInput, fmt::format("{} and {} contradict each other about case {}", files_[from_[at]], place, hex(row->id)));
    if (doubles_++ == 0) first_double_ = fmt::format("{} in {} and {}", hex(row->id), files_[from_[at]], place);
  }

  void complain(std::string text) { results_.complaints.push_back(std::move(text)); }

  Results results_;
  std::unordered_map<uint64_t, uint64_t> ranks_;
  std::vector<std::string> files_;
  std::vector<uint32_t> from_;  // which file a row is of
  uint64_t doubles_ = 0;
  std::string first_double_;
};

}  // namespace

void write_outline(const std::string& folder, const Outline& outline) {
  const std::string path = (fs::path(folder) / fmt::format("plan-{}.json", hex(outline.identity))).string();
  const std::string text = outline_json(outline);
  if (try_read_file(path) != text) rewrite_file(path, text);
}

std::string read_results_file(const std::string& path) { return read_file(path, kLogLimit); }

Results read_results(const std::vector<std::string>& folders) {
  Reader reader(the_outline(outlines_in(folders)));
  for (const std::string& folder : folders)
    for (const std::string& path : shard_files(folder)) reader.read(path);
  return reader.finish(folders);
}

}  // namespace ipos::tools::campaign
