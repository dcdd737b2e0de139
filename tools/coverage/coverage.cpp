// Adding up and counting.
#include "tools/coverage/coverage.hpp"

#include <filesystem>
#include <utility>

namespace ipos::tools::coverage {
namespace {

// Another build of the source may jump where this one goes on.
void add(Condition& condition, Condition other) {
  if (!condition.tested() && condition.ways[0].to == Place{}) {
    condition = other;
    return;
  }
  if (other.ways[0].to == condition.ways[1].to && other.ways[1].to == condition.ways[0].to)
    std::swap(other.ways[0], other.ways[1]);
  for (size_t n = 0; n < condition.ways.size(); ++n) condition.ways[n].count += other.ways[n].count;
}

void count(Figure& figure, uint64_t times) {
  ++figure.all;
  if (times != 0) ++figure.covered;
}

}  // namespace

Figure& Figure::operator+=(const Figure& other) {
  covered += other.covered;
  all += other.all;
  return *this;
}

double Figure::rate() const {
  return all == 0 ? 1.0 : static_cast<double>(covered) / static_cast<double>(all);
}

Figures& Figures::operator+=(const Figures& other) {
  lines += other.lines;
  branches += other.branches;
  functions += other.functions;
  return *this;
}

void Coverage::merge(const Coverage& other) {
  for (const auto& [name, source] : other.files) {
    SourceFile& file = files[name];
    for (const auto& [line, times] : source.lines) file.lines[line] += times;
    for (const auto& [key, condition] : source.conditions) add(file.conditions[key], condition);
    for (const auto& [function, entry] : source.functions) {
      Function& mine = file.functions[function];
      mine.line = entry.line;
      mine.count += entry.count;
    }
  }
}

Coverage Coverage::named_from(const std::string& folder) const {
  namespace fs = std::filesystem;
  Coverage named;
  for (const auto& [name, file] : files) {
    const fs::path whole = fs::weakly_canonical(fs::path(folder) / name);
    const fs::path relative = whole.lexically_relative(folder);
    const bool inside = !relative.empty() && *relative.begin() != "..";
    named.merge({{{(inside ? relative : whole).generic_string(), file}}});
  }
  return named;
}

Figures figures(const SourceFile& file) {
  Figures all;
  for (const auto& [line, times] : file.lines) count(all.lines, times);
  for (const auto& [key, condition] : file.conditions)
    for (const Condition::Way& way : condition.ways) count(all.branches, way.count);
  for (const auto& [name, function] : file.functions) count(all.functions, function.count);
  return all;
}

Figures figures(const Coverage& coverage) {
  Figures all;
  for (const auto& [name, file] : coverage.files) all += figures(file);
  return all;
}

}  // namespace ipos::tools::coverage
