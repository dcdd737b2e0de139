// Records in the order geninfo writes them. A block is a condition, its branch 0 goes on, branch 1 jumps.
#include <fmt/format.h>

#include <ostream>

#include "tools/coverage/write.hpp"

namespace ipos::tools::coverage {

void write_lcov(std::ostream& out, const Coverage& coverage) {
  for (const auto& [name, file] : coverage.files) {
    const Figures all = figures(file);
    out << "TN:\nSF:" << name << '\n';
    for (const auto& [function, entry] : file.functions)
      out << fmt::format("FN:{},{}\n", entry.line, function);
    for (const auto& [function, entry] : file.functions)
      out << fmt::format("FNDA:{},{}\n", entry.count, function);
    out << fmt::format("FNF:{}\nFNH:{}\n", all.functions.all, all.functions.covered);
    uint32_t line = 0, block = 0;
    for (const auto& [key, condition] : file.conditions) {
      block = key.at.line == line ? block + 1 : 0;
      line = key.at.line;
      for (size_t n = 0; n < condition.ways.size(); ++n)
        out << fmt::format("BRDA:{},{},{},{}\n", line, block, n,
                           condition.tested() ? std::to_string(condition.ways[n].count) : "-");
    }
    out << fmt::format("BRF:{}\nBRH:{}\n", all.branches.all, all.branches.covered);
    for (const auto& [number, times] : file.lines) out << fmt::format("DA:{},{}\n", number, times);
    out << fmt::format("LF:{}\nLH:{}\nend_of_record\n", all.lines.all, all.lines.covered);
  }
}

}  // namespace ipos::tools::coverage
