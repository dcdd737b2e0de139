// The functions of the C library that ports call, in front of the library's own: what is not for the kernel in memory
// is handed to the real one by its number.
#include "tests/runtime/os_port/kernel_in_memory.hpp"

#include <dlfcn.h>
#include <fcntl.h>
#include <linux/errqueue.h>
#include <linux/net_tstamp.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdarg>
#include <cstring>

namespace ipos::tests {
namespace {

KernelInMemory* in_memory = nullptr;

// A descriptor that only has a number: the ports close it.
int numbered() { return static_cast<int>(syscall(SYS_openat, AT_FDCWD, "/dev/null", O_RDWR | O_CLOEXEC, 0)); }

int failed(int error) {
  errno = error;
  return -1;
}

timespec time_of(int64_t nanoseconds) {
  constexpr int64_t kSecond = 1'000'000'000;
  return {static_cast<time_t>(nanoseconds / kSecond), static_cast<long>(nanoseconds % kSecond)};
}

// Control messages one behind the other, as recvmsg() gives them.
class Control {
 public:
  explicit Control(msghdr& message) : message_(message), room_(message.msg_controllen) {
    message.msg_controllen = 0;
  }

  template <typename Value>
  void add(int level, int type, const Value& value) {
    const size_t at = message_.msg_controllen;
    if (at + CMSG_SPACE(sizeof value) > room_) return;
    auto* const bytes = static_cast<char*>(message_.msg_control) + at;
    cmsghdr head{};
    head.cmsg_len = CMSG_LEN(sizeof value);
    head.cmsg_level = level;
    head.cmsg_type = type;
    std::memset(bytes, 0, CMSG_SPACE(sizeof value));
    std::memcpy(bytes, &head, sizeof head);
    std::memcpy(bytes + CMSG_LEN(0), &value, sizeof value);
    message_.msg_controllen += CMSG_SPACE(sizeof value);
  }

 private:
  msghdr& message_;
  size_t room_;
};

ssize_t take(KernelInMemory& kernel, msghdr& message) {
  if (kernel.packets.empty()) return failed(EAGAIN);
  const CanPacket packet = kernel.packets.front();
  kernel.packets.pop_front();
  if (packet.error != 0) return failed(packet.error);
  if (message.msg_iovlen != 1) return failed(EMSGSIZE);
  const size_t size = std::min(message.msg_iov->iov_len, sizeof packet.frame);
  std::memcpy(message.msg_iov->iov_base, &packet.frame, size);
  Control control(message);
  if (packet.level != 0) {
    control.add(packet.level, SO_RXQ_OVFL, uint32_t{99});
    control.add(packet.level, SO_TIMESTAMPING, std::array<timespec, 3>{time_of(7), {}, time_of(7)});
  }
  if (packet.stamped)
    control.add(SOL_SOCKET, SO_TIMESTAMPING,
                std::array<timespec, 3>{time_of(packet.software), {}, time_of(packet.hardware)});
  if (packet.lost) control.add(SOL_SOCKET, SO_RXQ_OVFL, *packet.lost);
  return static_cast<ssize_t>(size);
}

int answer_flags(KernelInMemory& kernel, ifreq& request) {
  ++kernel.flags_asked;
  kernel.asked_flags_of = request.ifr_name;
  if (kernel.flags_error != 0) return failed(kernel.flags_error);
  request.ifr_flags = kernel.flags;
  return 0;
}

}  // namespace

KernelInMemory::KernelInMemory() { in_memory = this; }
KernelInMemory::~KernelInMemory() { in_memory = nullptr; }

}  // namespace ipos::tests

using ipos::tests::failed;
using ipos::tests::in_memory;

extern "C" {

unsigned if_nametoindex(const char* name) noexcept {
  if (in_memory != nullptr && name == ipos::tests::KernelInMemory::kInterface)
    return ipos::tests::KernelInMemory::kIndex;
  const int any = static_cast<int>(syscall(SYS_socket, AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  if (any < 0) return 0;
  ifreq request{};
  std::strncpy(request.ifr_name, name, sizeof request.ifr_name - 1);
  const bool known = syscall(SYS_ioctl, any, SIOCGIFINDEX, &request) == 0;
  close(any);
  return known ? static_cast<unsigned>(request.ifr_ifindex) : 0;
}

int socket(int domain, int type, int protocol) noexcept {
  if (in_memory != nullptr && domain == PF_CAN) {
    if (in_memory->socket_error != 0) return failed(in_memory->socket_error);
    in_memory->socket_type = type;
    in_memory->socket_protocol = protocol;
    return in_memory->can_ = ipos::tests::numbered();
  }
  if (in_memory != nullptr && domain == AF_NETLINK) {
    if (in_memory->ask_socket_error != 0) return failed(in_memory->ask_socket_error);
    if (type != (SOCK_RAW | SOCK_CLOEXEC) || protocol != 0) return failed(ESOCKTNOSUPPORT);  // NETLINK_ROUTE
    return in_memory->ask_ = ipos::tests::numbered();
  }
  return static_cast<int>(syscall(SYS_socket, domain, type, protocol));
}

int setsockopt(int descriptor, int level, int option, const void* value, socklen_t size) noexcept {
  if (in_memory == nullptr || descriptor != in_memory->can_)
    return static_cast<int>(syscall(SYS_setsockopt, descriptor, level, option, value, size));
  if (const auto error = in_memory->option_errors.find({level, option});
      error != in_memory->option_errors.end())
    return failed(error->second);
  in_memory->options[{level, option}] = std::string(static_cast<const char*>(value), size);
  return 0;
}

int bind(int descriptor, const sockaddr* address, socklen_t size) noexcept {
  if (in_memory == nullptr || descriptor != in_memory->can_)
    return static_cast<int>(syscall(SYS_bind, descriptor, address, size));
  if (in_memory->bind_error != 0) return failed(in_memory->bind_error);
  if (size != sizeof in_memory->bound) return failed(EINVAL);
  std::memcpy(&in_memory->bound, address, size);
  return 0;
}

ssize_t write(int descriptor, const void* bytes, size_t size) {
  if (in_memory == nullptr || descriptor != in_memory->can_)
    return syscall(SYS_write, descriptor, bytes, size);
  ++in_memory->attempts;
  if (!in_memory->refusals.empty()) {
    const int error = in_memory->refusals.front();
    in_memory->refusals.pop_front();
    if (error != 0) return failed(error);
  }
  can_frame frame{};
  if (size != sizeof frame) return failed(EINVAL);
  std::memcpy(&frame, bytes, size);
  in_memory->written.push_back(frame);
  return static_cast<ssize_t>(size);
}

ssize_t send(int descriptor, const void* bytes, size_t size, int flags) {
  if (in_memory == nullptr || descriptor != in_memory->ask_)
    return syscall(SYS_sendto, descriptor, bytes, size, flags, nullptr, 0);
  if (flags != 0) return failed(EOPNOTSUPP);
  if (in_memory->ask_error != 0) return failed(in_memory->ask_error);
  in_memory->asked.assign(static_cast<const char*>(bytes), size);
  return static_cast<ssize_t>(size);
}

ssize_t recv(int descriptor, void* bytes, size_t size, int flags) {
  if (in_memory == nullptr || descriptor != in_memory->ask_)
    return syscall(SYS_recvfrom, descriptor, bytes, size, flags, nullptr, nullptr);
  if (flags != 0) return failed(EOPNOTSUPP);
  if (in_memory->answer_error != 0) return failed(in_memory->answer_error);
  return static_cast<ssize_t>(in_memory->link.copy(static_cast<char*>(bytes), size));
}

ssize_t recvmsg(int descriptor, msghdr* message, int flags) {
  if (in_memory == nullptr || descriptor != in_memory->can_)
    return syscall(SYS_recvmsg, descriptor, message, flags);
  return flags == 0 ? ipos::tests::take(*in_memory, *message) : failed(EOPNOTSUPP);
}

int ioctl(int descriptor, unsigned long request, ...) noexcept {
  va_list arguments;
  va_start(arguments, request);
  void* const argument = va_arg(arguments, void*);
  va_end(arguments);
  if (in_memory != nullptr && descriptor == in_memory->can_ && request == SIOCGIFFLAGS)
    return ipos::tests::answer_flags(*in_memory, *static_cast<ifreq*>(argument));
  if (in_memory != nullptr && in_memory->driver)
    if (const auto error = in_memory->driver(request, argument)) return *error == 0 ? 0 : failed(*error);
  return static_cast<int>(syscall(SYS_ioctl, descriptor, request, argument));
}

int tcsetattr(int descriptor, int when, const termios* settings) noexcept {
  static const auto real = reinterpret_cast<int (*)(int, int, const termios*)>(dlsym(RTLD_NEXT, "tcsetattr"));
  termios wanted = *settings;
  if (in_memory != nullptr && in_memory->set)
    if (const auto error = in_memory->set(wanted)) return *error == 0 ? 0 : failed(*error);
  return real(descriptor, when, &wanted);
}

int tcgetattr(int descriptor, termios* settings) noexcept {
  static const auto real = reinterpret_cast<int (*)(int, termios*)>(dlsym(RTLD_NEXT, "tcgetattr"));
  const int result = real(descriptor, settings);
  if (result == 0 && in_memory != nullptr && in_memory->got) in_memory->got(*settings);
  return result;
}

int fstat(int descriptor, struct stat* status) noexcept {
  const auto result = static_cast<int>(syscall(SYS_fstat, descriptor, status));
  if (result == 0 && in_memory != nullptr && in_memory->major && S_ISCHR(status->st_mode))
    status->st_rdev = makedev(*in_memory->major, 0);
  return result;
}

}  // extern "C"
