// posix_openpt, and a link to the other end.
#include "runtime/port/pty.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <termios.h>

#include <array>
#include <cerrno>
#include <cstdlib>

namespace ipos::runtime {
namespace {

// Where a link leads, empty when `path` is no link.
std::string link_target(const std::string& path) {
  std::array<char, 4096> target{};
  const ssize_t size = readlink(path.c_str(), target.data(), target.size());
  return size < 0 ? std::string() : std::string(target.data(), static_cast<size_t>(size));
}

bool is_left_over(const std::string& path) {
  const std::string target = link_target(path);
  struct stat status {};
  return target.starts_with("/dev/pts/") || (!target.empty() && stat(path.c_str(), &status) != 0);
}

}  // namespace

tl::expected<Pty, PortError> Pty::create(const std::string& path, size_t limit) {
  if (path.empty()) return tl::unexpected(port_error(PortFault::BadName, "pty:", "write pty:/path"));
  struct stat status {};
  if (lstat(path.c_str(), &status) == 0) {
    if (!is_left_over(path)) return tl::unexpected(port_error(PortFault::PathTaken, path));
    if (unlink(path.c_str()) != 0) return tl::unexpected(system_error(errno, path));
  }
  Descriptor master(posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  std::array<char, 128> device{};
  if (!master.is_open() || grantpt(master.get()) != 0 || unlockpt(master.get()) != 0 ||
      ptsname_r(master.get(), device.data(), device.size()) != 0)
    return tl::unexpected(port_error(PortFault::NoPseudoTerminal, path, system_error(errno, "pty").text));
  {
    // Opened and closed once: from then on reading tells whether a program is attached. The raw setting
    // stays.
    const Descriptor other(::open(device.data(), O_RDWR | O_NOCTTY | O_CLOEXEC));
    termios settings{};
    if (!other.is_open() || tcgetattr(other.get(), &settings) != 0)
      return tl::unexpected(
          port_error(PortFault::NoPseudoTerminal, path, system_error(errno, device.data()).text));
    cfmakeraw(&settings);
    tcsetattr(other.get(), TCSANOW, &settings);
  }
  if (symlink(device.data(), path.c_str()) != 0) {
    const int error = errno;
    return tl::unexpected(error == ENOENT ? port_error(PortFault::BadName, path, "the folder does not exist")
                                          : system_error(error, path));
  }
  return Pty(path, device.data(), std::move(master), limit);
}

Pty::~Pty() {
  if (!device_.empty() && master_.is_open() && link_target(path_) == device_) unlink(path_.c_str());
}

size_t Pty::read(std::span<char> into) {
  const ssize_t size = ::read(master_.get(), into.data(), into.size());
  if (size > 0) {
    attached_ = true;
    return static_cast<size_t>(size);
  }
  const bool attached = size < 0 && errno != EIO;
  if (attached_ && !attached) {
    out_.clear();
    tcflush(master_.get(), TCOFLUSH);
  }
  attached_ = attached;
  return 0;
}

bool Pty::write(std::string_view bytes) {
  if (!attached_) return true;
  if (!out_.push(bytes)) return false;
  flush();
  return true;
}

void Pty::flush() {
  if (out_.write_to(master_.get()) != 0) out_.clear();
}

}  // namespace ipos::runtime
