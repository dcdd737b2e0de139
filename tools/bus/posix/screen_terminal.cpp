// termios.
#include "tools/bus/screen_terminal.hpp"

#include <poll.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

namespace ipos::tools {

struct ScreenKeys::Before {
  termios settings;
};

ScreenSize screen_size() {
  winsize size{};
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return {};
  return {size.ws_col, size.ws_row};
}

ScreenKeys::ScreenKeys() {
  termios before{};
  if (isatty(STDIN_FILENO) == 0 || tcgetattr(STDIN_FILENO, &before) != 0) return;
  termios keys = before;
  keys.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
  if (tcsetattr(STDIN_FILENO, TCSANOW, &keys) == 0) before_ = std::make_unique<Before>(Before{before});
}

ScreenKeys::~ScreenKeys() {
  if (before_) tcsetattr(STDIN_FILENO, TCSANOW, &before_->settings);
}

std::optional<char> ScreenKeys::next() {
  pollfd polled{STDIN_FILENO, POLLIN, 0};
  char key = 0;
  if (!before_ || poll(&polled, 1, 0) != 1 || (polled.revents & POLLIN) == 0 || ::read(STDIN_FILENO, &key, 1) != 1)
    return std::nullopt;
  return key;
}

}  // namespace ipos::tools
