// The three streams that a process begins with.
#pragma once

namespace ipos::tools {

// Before anything is read, written or opened.
void prepare_streams();

// Whether they are a window that was opened for this process alone, as a double click does on Windows. It closes with the process.
bool has_own_window();
// Until somebody has read what stands in that window.
void wait_for_reader();

}  // namespace ipos::tools
