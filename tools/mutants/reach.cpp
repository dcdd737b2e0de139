// From coverage to lines.
#include "tools/mutants/reach.hpp"

#include <algorithm>
#include <filesystem>

namespace ipos::tools::mutants {

Reach::Reach(const std::vector<coverage::Coverage>& tests) : executed_(tests.size()) {
  for (size_t n = 0; n < tests.size(); ++n)
    for (const auto& [path, file] : tests[n].files) {
      const std::string plain = std::filesystem::path(path).lexically_normal().generic_string();
      for (const auto& [line, times] : file.lines) {
        with_code_[plain].insert(line);
        if (times != 0) executed_[n][plain].insert(line);
      }
    }
}

bool Reach::has_one(const LinesOfFiles& files, const Lines& lines) {
  const auto file = files.find(lines.file);
  if (file == files.end()) return false;
  const auto line = file->second.lower_bound(lines.first);
  return line != file->second.end() && *line <= lines.last;
}

std::vector<size_t> Reach::of(const Planted& planted) const {
  const auto any = [](const LinesOfFiles& files, const std::vector<Lines>& all) {
    return std::any_of(all.begin(), all.end(), [&](const Lines& lines) { return has_one(files, lines); });
  };
  const std::vector<Lines>& lines = any(with_code_, planted.executed) ? planted.executed : planted.functions;
  std::vector<size_t> tests;
  for (size_t n = 0; n < executed_.size(); ++n)
    if (any(executed_[n], lines)) tests.push_back(n);
  return tests;
}

}  // namespace ipos::tools::mutants
