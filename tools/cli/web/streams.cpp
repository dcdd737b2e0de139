// The three streams are always there.
#include "tools/cli/streams.hpp"

namespace ipos::tools {

void prepare_streams() {}

}  // namespace ipos::tools
