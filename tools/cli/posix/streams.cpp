// Without one of the three streams the next file that is opened would get its number, and its text.
#include "tools/cli/streams.hpp"

#include <fcntl.h>
#include <unistd.h>

namespace ipos::tools {

void prepare_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(stream, F_GETFD) < 0) static_cast<void>(open("/dev/null", O_RDONLY));
}

bool has_own_window() { return false; }
void wait_for_reader() {}

}  // namespace ipos::tools
