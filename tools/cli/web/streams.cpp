// The three streams are always there.
#include "tools/cli/streams.hpp"

namespace ipos::tools {

void prepare_streams() {}

bool has_own_window() { return false; }
void wait_for_reader() {}

}  // namespace ipos::tools
