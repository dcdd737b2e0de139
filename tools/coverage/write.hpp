// The forms of a coverage report. The same coverage gives the same bytes.
#pragma once

#include <iosfwd>

#include "tools/coverage/coverage.hpp"

namespace ipos::tools::coverage {

// lcov's tracefile (geninfo(1)), which genhtml reads.
void write_lcov(std::ostream& out, const Coverage& coverage);

// Cobertura's XML (coverage-04.dtd).
void write_cobertura(std::ostream& out, const Coverage& coverage);

// Figures of each file, then what was not executed.
void write_text(std::ostream& out, const Coverage& coverage);

}  // namespace ipos::tools::coverage
