// The forms of traces by the endings of their files: one table for the run that writes one and for the verb that makes another
// of it.
#pragma once

#include <string_view>

#include "tools/recording/trace.hpp"

namespace ipos::tools {

// An ending that the options of traces know (tools/cli/output_forms.hpp); none is that of standard output, CSV.
TraceForm trace_form(std::string_view ending);

}  // namespace ipos::tools
