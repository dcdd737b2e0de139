// One package, a class for each source file. Paths are as the compiler was given them, so the source root is
// the folder it ran in.
#include <fmt/format.h>

#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include "tools/cli/xml_text.hpp"
#include "tools/coverage/write.hpp"

namespace ipos::tools::coverage {
namespace {

std::string rates(const Figures& all) {
  return fmt::format("line-rate=\"{:.4f}\" branch-rate=\"{:.4f}\"", all.lines.rate(), all.branches.rate());
}

size_t taken(const Condition& condition) {
  return static_cast<size_t>(condition.ways[0].count != 0) +
         static_cast<size_t>(condition.ways[1].count != 0);
}

std::string line_element(uint32_t line, uint64_t times, const std::vector<const Condition*>& conditions) {
  const std::string begin = fmt::format("            <line number=\"{}\" hits=\"{}\"", line, times);
  if (conditions.empty()) return begin + "/>\n";
  std::string inner;
  size_t covered = 0;
  for (size_t n = 0; n < conditions.size(); ++n) {
    covered += taken(*conditions[n]);
    inner += fmt::format("                <condition number=\"{}\" type=\"jump\" coverage=\"{}%\"/>\n", n,
                         taken(*conditions[n]) * 50);
  }
  const size_t all = 2 * conditions.size();
  return begin +
         fmt::format(" branch=\"true\" condition-coverage=\"{}% ({}/{})\">\n", covered * 100 / all, covered,
                     all) +
         "              <conditions>\n" + inner + "              </conditions>\n            </line>\n";
}

std::string class_element(const std::string& name, const SourceFile& file) {
  std::string out =
      fmt::format("        <class name=\"{}\" filename=\"{}\" {} complexity=\"0\">\n          <methods>\n",
                  xml_text(name.substr(name.rfind('/') + 1)), xml_text(name), rates(figures(file)));
  for (const auto& [function, entry] : file.functions) {
    const int rate = entry.count != 0 ? 1 : 0;
    out += fmt::format(
        "            <method name=\"{0}\" signature=\"()\" line-rate=\"{1}\" branch-rate=\"{1}\" "
        "complexity=\"0\">\n"
        "              <lines><line number=\"{2}\" hits=\"{3}\"/></lines>\n            </method>\n",
        xml_text(function), rate, entry.line, entry.count);
  }
  out += "          </methods>\n          <lines>\n";
  auto condition = file.conditions.begin();
  for (const auto& [line, times] : file.lines) {
    std::vector<const Condition*> conditions;
    for (; condition != file.conditions.end() && condition->first.at.line == line; ++condition)
      conditions.push_back(&condition->second);
    out += line_element(line, times, conditions);
  }
  return out + "          </lines>\n        </class>\n";
}

}  // namespace

void write_cobertura(std::ostream& out, const Coverage& coverage) {
  const Figures all = figures(coverage);
  out << fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<!DOCTYPE coverage SYSTEM \"http://cobertura.sourceforge.net/xml/coverage-04.dtd\">\n"
      "<coverage {0} lines-covered=\"{1}\" lines-valid=\"{2}\" branches-covered=\"{3}\" "
      "branches-valid=\"{4}\" complexity=\"0\" version=\"ipos\" timestamp=\"0\">\n"
      "  <sources>\n    <source>.</source>\n  </sources>\n"
      "  <packages>\n    <package name=\"ipos\" {0} complexity=\"0\">\n      <classes>\n",
      rates(all), all.lines.covered, all.lines.all, all.branches.covered, all.branches.all);
  for (const auto& [name, file] : coverage.files) out << class_element(name, file);
  out << "      </classes>\n    </package>\n  </packages>\n</coverage>\n";
}

}  // namespace ipos::tools::coverage
