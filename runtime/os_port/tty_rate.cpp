// TCGETS2 and TCSETS2.
#include "runtime/os_port/tty_rate.hpp"

#include <asm/termbits.h>
#include <sys/ioctl.h>

#include <cerrno>

namespace ipos::runtime {

tl::expected<uint32_t, int> set_any_rate(int descriptor, uint32_t baud) {
  termios2 settings{};
  if (ioctl(descriptor, TCGETS2, &settings) != 0) return tl::unexpected(errno);
  settings.c_cflag &= ~static_cast<tcflag_t>(CBAUD | CIBAUD);
  settings.c_cflag |= BOTHER | BOTHER << IBSHIFT;
  settings.c_ispeed = settings.c_ospeed = baud;
  // A driver that cannot do it keeps or rounds the rate and reports no error, so it is read back.
  if (ioctl(descriptor, TCSETS2, &settings) != 0 || ioctl(descriptor, TCGETS2, &settings) != 0)
    return tl::unexpected(errno);
  return settings.c_ospeed;
}

}  // namespace ipos::runtime
