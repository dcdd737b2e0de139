// A table of figures, then for each file that is not fully covered the lines and ways that are missing.
#include <fmt/format.h>

#include <algorithm>
#include <ostream>
#include <string>

#include "tools/coverage/write.hpp"

namespace ipos::tools::coverage {
namespace {

std::string figure_text(const Figure& figure) {
  if (figure.all == 0) return fmt::format("{:>18}", "none");
  return fmt::format("{:>11} {:5.1f}%", fmt::format("{}/{}", figure.covered, figure.all),
                     100 * figure.rate());
}

std::string row(const std::string& name, size_t width, const Figures& all) {
  return fmt::format("{:<{}}{}{}{}\n", name, width, figure_text(all.lines), figure_text(all.branches),
                     figure_text(all.functions));
}

std::string place_text(const Place& place) { return fmt::format("{}:{}", place.line, place.column); }

// "4, 7-9": neighbours among the lines that have code.
std::string missed_lines(const SourceFile& file) {
  std::string out;
  for (auto line = file.lines.begin(); line != file.lines.end(); ++line) {
    if (line->second != 0) continue;
    auto last = line;
    while (std::next(last) != file.lines.end() && std::next(last)->second == 0) ++last;
    out += fmt::format("{}{}", out.empty() ? "" : ", ", line->first);
    if (last != line) out += fmt::format("-{}", last->first);
    line = last;
  }
  return out;
}

// Of lines that were executed; nothing to say of the others.
std::string missed_branches(const SourceFile& file) {
  std::string out;
  for (const auto& [key, condition] : file.conditions) {
    const auto line = file.lines.find(key.at.line);
    if (line == file.lines.end() || line->second == 0) continue;
    if (!condition.tested()) {
      out += fmt::format("  {}: never tested\n", place_text(key.at));
      continue;
    }
    for (size_t n = 0; n < condition.ways.size(); ++n)
      if (condition.ways[n].count == 0)
        out += fmt::format("  {}: never goes to {}, {} time{} to {}\n", place_text(key.at),
                           place_text(condition.ways[n].to), condition.ways[1 - n].count,
                           condition.ways[1 - n].count == 1 ? "" : "s", place_text(condition.ways[1 - n].to));
  }
  return out;
}

}  // namespace

void write_text(std::ostream& out, const Coverage& coverage) {
  size_t width = std::string_view("coverage").size();
  for (const auto& [name, file] : coverage.files) width = std::max(width, name.size());
  out << fmt::format("{:<{}}{:>18}{:>18}{:>18}\n", "coverage", width, "lines", "branches", "functions");
  for (const auto& [name, file] : coverage.files) out << row(name, width, figures(file));
  if (coverage.files.size() > 1) out << row("total", width, figures(coverage));
  for (const auto& [name, file] : coverage.files) {
    std::string missed;
    if (const std::string lines = missed_lines(file); !lines.empty())
      missed = fmt::format("  lines not executed: {}\n", lines);
    missed += missed_branches(file);
    for (const auto& [function, entry] : file.functions)
      if (entry.count == 0) missed += fmt::format("  function never called: {}\n", function);
    if (!missed.empty()) out << '\n' << name << ":\n" << missed;
  }
}

}  // namespace ipos::tools::coverage
