// posix_openpt, a link to the other end, and a lock for the link.
#include "runtime/os_port/pty.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <termios.h>

#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdlib>
#include <functional>

#include "runtime/os_port/posix_bytes.hpp"

namespace ipos::runtime {
namespace {

// Where a link leads, empty when `path` is no link.
std::string link_target(const std::string& path) {
  std::array<char, 4096> target{};
  const ssize_t size = readlink(path.c_str(), target.data(), target.size());
  return size < 0 ? std::string() : std::string(target.data(), static_cast<size_t>(size));
}

// Two runs must not share a path: the second would take the link away from the first, which could not be
// reached any more. The lock is a name in the abstract namespace of Unix sockets (unix(7)): folder and file
// name, however the path is written. It needs no file, and the kernel drops it when its owner dies, however
// that was. Nobody connects to it. Not open: errno tells why, EADDRINUSE is another owner.
Descriptor lock_path(const std::string& path) {
  const size_t slash = path.rfind('/');
  const std::string folder = slash == std::string::npos ? "." : path.substr(0, slash + 1);
  struct stat status {};
  if (stat(folder.c_str(), &status) != 0) return Descriptor();
  const std::string name = path.substr(slash + 1);  // all of it without a slash
  const std::string id =
      fmt::format("ipos-pty:{:x}:{:x}:{:x}", status.st_dev, status.st_ino, std::hash<std::string>()(name));
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  id.copy(address.sun_path + 1, sizeof address.sun_path - 1);
  const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + id.size());
  Descriptor lock(socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  if (lock.is_open() && bind(lock.get(), reinterpret_cast<const sockaddr*>(&address), size) != 0)
    return Descriptor();
  return lock;
}

bool is_left_over(const std::string& path) {
  const std::string target = link_target(path);
  struct stat status {};
  return target.starts_with("/dev/pts/") || (!target.empty() && stat(path.c_str(), &status) != 0);
}

// Speeds that no program asks for. The speed of a pseudo-terminal means nothing, but the C library refuses
// settings with parity, which it cannot have, when they change nothing else; so a program's second opening
// with 8E1 would fail. There are two of them, as the program's own comparison may just be under way.
constexpr speed_t kMarks[] = {B50, B75};

}  // namespace

tl::expected<Pty, PortError> Pty::create(const std::string& path, size_t limit) {
  if (path.empty()) return tl::unexpected(port_error(PortFault::BadName, "pty:", "write pty:/path"));
  Descriptor lock = lock_path(path);
  if (!lock.is_open()) {
    switch (errno) {
      case EADDRINUSE:
        return tl::unexpected(
            port_error(PortFault::InUse, path, "another run of ipos has made its link there"));
      case ENOENT:
      case ENOTDIR: return tl::unexpected(port_error(PortFault::BadName, path, "the folder does not exist"));
      default: return tl::unexpected(system_error(errno, path));
    }
  }
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
    cfsetspeed(&settings, kMarks[0]);
    tcsetattr(other.get(), TCSANOW, &settings);
  }
  if (symlink(device.data(), path.c_str()) != 0) return tl::unexpected(system_error(errno, path));
  return Pty(path, device.data(), std::move(lock), std::move(master), limit);
}

Pty::~Pty() {
  if (!device_.empty() && master_.is_open() && link_target(path_) == device_) unlink(path_.c_str());
}

void Pty::renew_speed() {
  termios settings{};
  if (tcgetattr(master_.get(), &settings) != 0 || cfgetospeed(&settings) == kMarks[second_mark_ ? 1 : 0])
    return;
  second_mark_ = !second_mark_;
  cfsetspeed(&settings, kMarks[second_mark_ ? 1 : 0]);
  tcsetattr(master_.get(), TCSANOW, &settings);
}

size_t Pty::read(std::span<char> into) {
  renew_speed();
  const ssize_t size = ::read(master_.get(), into.data(), into.size());
  if (size > 0) {
    attached_ = true;
    return static_cast<size_t>(size);
  }
  const bool attached = size < 0 && errno != EIO;
  if (attached_ && !attached) {
    // What the program has not read is not for the next one.
    out_.clear();
    const Descriptor other(::open(device_.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC));
    tcflush(other.get(), TCIFLUSH);
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
  if (out_.write_by([this](std::string_view bytes) { return write_some(master_.get(), bytes); }) != 0)
    out_.clear();
}

}  // namespace ipos::runtime
