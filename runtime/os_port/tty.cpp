// termios(3), TIOCSRS485 and the low-latency flag of serial drivers.
#include "runtime/os_port/tty.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/serial.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <termios.h>

#include <cerrno>

#include "runtime/os_port/descriptor.hpp"
#include "runtime/os_port/posix_bytes.hpp"
#include "runtime/os_port/tty_rate.hpp"

namespace ipos::runtime {
namespace {

struct BaudRate {
  uint32_t baud;
  speed_t code;
};
constexpr BaudRate kBaudCodes[] = {
    {9600, B9600},       {19200, B19200},     {38400, B38400},    {57600, B57600},   {115200, B115200},
    {230400, B230400},   {460800, B460800},   {500000, B500000},  {921600, B921600}, {1000000, B1000000},
    {1500000, B1500000}, {2000000, B2000000}, {3000000, B3000000}};

// Nothing for a rate without a name: set_any_rate().
const BaudRate* find_baud(uint32_t baud) {
  for (const BaudRate& row : kBaudCodes)
    if (row.baud == baud) return &row;
  return nullptr;
}

// Half duplex by the driver: it switches the transmitter on for our bytes and off after the last one.
bool switch_rs485(int descriptor) {
  serial_rs485 rs485{};
  rs485.flags = SER_RS485_ENABLED | SER_RS485_RTS_ON_SEND;
  return ioctl(descriptor, TIOCSRS485, &rs485) == 0;
}

// Bytes are passed on as they come, not after the driver's own pause (USB adapters: 16 ms).
bool set_low_latency(int descriptor) {
  serial_struct serial{};
  if (ioctl(descriptor, TIOCGSERIAL, &serial) != 0) return false;
  serial.flags |= ASYNC_LOW_LATENCY;
  return ioctl(descriptor, TIOCSSERIAL, &serial) == 0;
}

// A pseudo-terminal (Linux: majors 136 to 143) has neither a speed nor parity, and the program at its other
// end may change what it says of them at any time.
bool is_pseudo_terminal(int descriptor) {
  struct stat status {};
  return fstat(descriptor, &status) == 0 && S_ISCHR(status.st_mode) && major(status.st_rdev) >= 136 &&
         major(status.st_rdev) <= 143;
}

}  // namespace

struct Tty::System {
  Descriptor descriptor;
  termios former;
};

Tty::Tty(std::unique_ptr<System> system) : system_(std::move(system)) {}
Tty::Tty(Tty&&) noexcept = default;

int Tty::descriptor() const { return system_->descriptor.get(); }

tl::expected<size_t, int> Tty::read(std::span<char> into) { return read_some(descriptor(), into); }

tl::expected<size_t, int> Tty::write(std::string_view bytes) { return write_some(descriptor(), bytes); }

tl::expected<Tty, PortError> Tty::open(const std::string& path, const TtySettings& settings,
                                       PortNotes& notes) {
  const BaudRate* rate = find_baud(settings.baud);
  if (settings.baud < kSlowestRate || settings.baud > kFastestRate)
    return tl::unexpected(port_error(PortFault::NoBaudRate, path, fmt::format("{} bit/s", settings.baud)));
  Descriptor descriptor(::open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  if (!descriptor.is_open()) {
    const int error = errno;
    return tl::unexpected(error == EACCES
                              ? port_error(PortFault::NoPermission, path, "is your user in group dialout?")
                              : system_error(error, path));
  }
  termios former{};
  if (tcgetattr(descriptor.get(), &former) != 0) return tl::unexpected(system_error(errno, path));
  // Other programs keep off by the lock, all but root's by the device's own flag.
  if (flock(descriptor.get(), LOCK_EX | LOCK_NB) != 0)
    return tl::unexpected(port_error(PortFault::InUse, path));
  if (ioctl(descriptor.get(), TIOCEXCL) != 0) return tl::unexpected(system_error(errno, path));
  Tty tty(std::unique_ptr<System>(new System{std::move(descriptor), former}));
  const int fd = tty.descriptor();
  termios wanted = former;
  cfmakeraw(&wanted);
  wanted.c_cflag &= static_cast<tcflag_t>(~(CSTOPB | PARODD | CRTSCTS | CSIZE | PARENB));
  wanted.c_cflag |= CS8 | CREAD | CLOCAL;
  wanted.c_iflag &= static_cast<tcflag_t>(~(IXON | IXOFF | IXANY | IGNPAR));
  const bool pseudo = is_pseudo_terminal(fd);
  if (settings.even_parity) {
    if (!pseudo) wanted.c_cflag |= PARENB;
    wanted.c_iflag |= INPCK | PARMRK;
  }
  const speed_t named = rate != nullptr ? rate->code : B9600;
  cfsetispeed(&wanted, named);
  cfsetospeed(&wanted, named);
  // TCSANOW succeeds when any one of the settings could be made, so they are read back.
  termios got{};
  if (tcsetattr(fd, TCSANOW, &wanted) != 0 || tcgetattr(fd, &got) != 0)
    return tl::unexpected(system_error(errno, path));
  if (!pseudo && cfgetospeed(&got) != named)
    return tl::unexpected(port_error(PortFault::NoBaudRate, path, fmt::format("{} bit/s", settings.baud)));
  if (rate == nullptr && !pseudo) {
    const auto has = set_any_rate(fd, settings.baud);
    if (!has || !is_close_rate(settings.baud, *has))
      return tl::unexpected(
          port_error(PortFault::NoBaudRate, path,
                     has ? other_rate(settings.baud, *has)
                         : fmt::format("{} bit/s: the driver has only the rates of termios", settings.baud)));
  }
  tty.parity_ = (got.c_cflag & PARENB) != 0;
  tty.marks_ = (got.c_iflag & PARMRK) != 0;
  if (settings.even_parity && !tty.parity_)
    notes.note("the device has no parity: neither sends it nor sees its errors");
  if (settings.rs485 && !switch_rs485(fd))
    notes.note("the driver does not switch RS-485 direction: the adapter has to do it");
  if (!set_low_latency(fd))
    notes.note("the driver has no low-latency flag: bytes may come late and in groups");
  tcflush(fd, TCIOFLUSH);
  return tty;
}

Tty::~Tty() {
  if (!system_) return;
  tcsetattr(descriptor(), TCSANOW, &system_->former);
  ioctl(descriptor(), TIOCNXCL);
}

}  // namespace ipos::runtime
