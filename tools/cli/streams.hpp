// The three streams that a process begins with.
#pragma once

namespace ipos::tools {

// Before anything is read, written or opened.
void prepare_streams();

}  // namespace ipos::tools
