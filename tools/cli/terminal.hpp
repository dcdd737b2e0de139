// What may be written to a terminal: one rule for all verbs.
#pragma once

namespace ipos::tools {

// Whether a file descriptor is a terminal that knows escape sequences, so that a line can be written over.
bool is_terminal(int descriptor);

// Whether what is written there gets colours: it is such a terminal, unless the variable NO_COLOR is set to anything (no-color.org).
bool has_colours(int descriptor);

}  // namespace ipos::tools
