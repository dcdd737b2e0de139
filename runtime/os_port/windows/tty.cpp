// A serial device of Windows. A read of one byte is always under way, so that its event wakes the loop as soon as a byte has
// come; the others that have come with it are read then. One piece of output at a time is on its way, so that nothing waits
// for the wire.
#include "runtime/os_port/tty.hpp"

#include <fmt/format.h>
#include <windows.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <utility>

#include "runtime/os_port/replaced_bytes.hpp"
#include "runtime/os_port/tty_rate.hpp"
#include "runtime/os_port/windows/serial_devices.hpp"

namespace ipos::runtime {
namespace {

constexpr size_t kPiece = 512;

// A serial device has no rights: what is denied is taken.
PortError opening_error(DWORD error, const std::string& path) {
  switch (error) {
    case ERROR_FILE_NOT_FOUND:
    case ERROR_PATH_NOT_FOUND: {
      const std::vector<std::string> there = serial_devices();
      return port_error(PortFault::NoSuchDevice, path,
                        there.empty() ? "there is none" : fmt::format("there is {}", fmt::join(there, ", ")));
    }
    case ERROR_ACCESS_DENIED:
    case ERROR_SHARING_VIOLATION: return system_error(EBUSY, path);
    case ERROR_INVALID_FUNCTION:
    case ERROR_INVALID_NAME: return system_error(ENOTTY, path);
    default: return port_error(PortFault::System, path, fmt::format("error {} of Windows", error));
  }
}

// What is asked of a driver, until it takes one: it may not switch the direction, or have no parity.
struct Way {
  bool rs485, parity;
};
constexpr Way kWays[] = {{true, true}, {false, true}, {true, false}, {false, false}};

bool set_state(HANDLE device, uint32_t baud, const Way& way) {
  DCB wanted{};
  wanted.DCBlength = sizeof wanted;
  wanted.BaudRate = baud;
  wanted.ByteSize = 8;
  wanted.StopBits = ONESTOPBIT;
  wanted.fBinary = TRUE;
  wanted.fParity = way.parity;
  wanted.Parity = way.parity ? EVENPARITY : NOPARITY;
  wanted.fErrorChar = way.parity;
  wanted.ErrorChar = static_cast<char>(ReplacedBytes::kReplacement);
  wanted.fDtrControl = DTR_CONTROL_ENABLE;
  wanted.fRtsControl = way.rs485 ? RTS_CONTROL_TOGGLE : RTS_CONTROL_ENABLE;
  return SetCommState(device, &wanted) != 0;
}

HANDLE new_event() { return CreateEventW(nullptr, TRUE, FALSE, nullptr); }

}  // namespace

struct Tty::System {
  explicit System(HANDLE opened) : device(opened) {
    for (OVERLAPPED* const operation : {&first, &reading, &writing}) operation->hEvent = new_event();
  }
  ~System() {
    if (writes) finish_writing();
    CancelIo(device);
    DWORD count = 0;
    if (waits) GetOverlappedResult(device, &first, &count, TRUE);
    if (has_former) SetCommState(device, &former);
    CloseHandle(device);
    for (const OVERLAPPED* const operation : {&first, &reading, &writing}) CloseHandle(operation->hEvent);
  }
  System(const System&) = delete;
  System& operator=(const System&) = delete;

  // The last words go out, but a device that takes none keeps nobody.
  void finish_writing() {
    constexpr DWORD kLongest = 1000;
    DWORD count = 0;
    if (WaitForSingleObject(writing.hEvent, kLongest) != WAIT_OBJECT_0) CancelIo(device);
    GetOverlappedResult(device, &writing, &count, TRUE);
  }

  // The read that waits for the next byte. False: the device has gone.
  bool wait_for_first() {
    waits = ReadFile(device, &first_byte, 1, nullptr, &first) != 0 || GetLastError() == ERROR_IO_PENDING;
    return waits;
  }

  HANDLE device;
  DCB former{};
  bool has_former = false;
  OVERLAPPED first{};
  char first_byte = 0;
  bool waits = false;
  OVERLAPPED reading{};
  ReplacedBytes replaced;
  OVERLAPPED writing{};
  std::array<char, kPiece> piece{};
  bool writes = false;
};

Tty::Tty(std::unique_ptr<System> system) : system_(std::move(system)) {}
Tty::Tty(Tty&&) noexcept = default;
Tty::~Tty() = default;

// A handle has 32 bits that mean something, and as many zeros.
int Tty::descriptor() const { return static_cast<int>(reinterpret_cast<intptr_t>(system_->first.hEvent)); }

tl::expected<Tty, PortError> Tty::open(const std::string& path, const TtySettings& settings,
                                       PortNotes& notes) {
  const PortError no_rate = port_error(PortFault::NoBaudRate, path, fmt::format("{} bit/s", settings.baud));
  if (settings.baud < kSlowestRate || settings.baud > kFastestRate) return tl::unexpected(no_rate);
  // COM10 and up are there only with this in front of them.
  const std::wstring name(path.begin(), path.end()), prefix = L"\\\\.\\";
  const std::wstring device = name.starts_with(prefix) ? name : prefix + name;
  const HANDLE opened = CreateFileW(device.c_str(), GENERIC_READ | GENERIC_WRITE, 0, nullptr, OPEN_EXISTING,
                                    FILE_FLAG_OVERLAPPED, nullptr);
  if (opened == INVALID_HANDLE_VALUE) return tl::unexpected(opening_error(GetLastError(), path));
  auto system = std::make_unique<System>(opened);
  system->former.DCBlength = sizeof(DCB);
  if (GetCommState(opened, &system->former) == 0)
    return tl::unexpected(port_error(PortFault::NotSerial, path));
  system->has_former = true;
  const bool rs485 = settings.rs485, parity = settings.even_parity;
  const auto taken = std::find_if(std::begin(kWays), std::end(kWays), [&](const Way& way) {
    return way.rs485 <= rs485 && way.parity <= parity && set_state(opened, settings.baud, way);
  });
  if (taken == std::end(kWays)) return tl::unexpected(no_rate);
  // A driver may round the rate and leave parity out without a word.
  DCB got{};
  got.DCBlength = sizeof got;
  if (GetCommState(opened, &got) == 0) return tl::unexpected(opening_error(GetLastError(), path));
  if (!is_close_rate(settings.baud, got.BaudRate))
    return tl::unexpected(port_error(PortFault::NoBaudRate, path, other_rate(settings.baud, got.BaudRate)));
  if (taken->rs485 != rs485)
    notes.note("the driver does not switch RS-485 direction: the adapter has to do it");
  // A read returns as soon as there is a byte, and waits for the first one as long as it takes.
  COMMTIMEOUTS times{MAXDWORD, MAXDWORD, MAXDWORD - 1, 0, 0};
  if (SetCommTimeouts(opened, &times) == 0) return tl::unexpected(opening_error(GetLastError(), path));
  PurgeComm(opened, PURGE_RXCLEAR | PURGE_TXCLEAR);
  if (!system->wait_for_first()) return tl::unexpected(opening_error(GetLastError(), path));
  Tty tty(std::move(system));
  tty.parity_ = parity && got.Parity == EVENPARITY;
  tty.marks_ = tty.parity_;
  if (tty.parity_ != parity) notes.note("the device has no parity: neither sends it nor sees its errors");
  return tty;
}

// What a device says that is not there any more differs from driver to driver.
tl::expected<size_t, int> Tty::read(std::span<char> into) {
  DWORD count = 0;
  if (!system_->waits && !system_->wait_for_first()) return tl::unexpected(EIO);
  if (GetOverlappedResult(system_->device, &system_->first, &count, FALSE) == 0)
    return GetLastError() == ERROR_IO_INCOMPLETE ? tl::expected<size_t, int>(0) : tl::unexpected(EIO);
  system_->waits = false;
  DWORD errors = 0;
  COMSTAT state{};
  if (ClearCommError(system_->device, &errors, &state) == 0) return tl::unexpected(EIO);
  std::array<char, kPiece> bytes{};
  size_t size = 0;
  if (count != 0) bytes[size++] = system_->first_byte;
  const size_t room = std::min(bytes.size(), into.size() / (marks_ ? ReplacedBytes::kLongestMark : 1));
  if (const size_t more = std::min<size_t>(room - size, state.cbInQue); more != 0) {
    if (ReadFile(system_->device, &bytes[size], static_cast<DWORD>(more), nullptr, &system_->reading) == 0 &&
        GetLastError() != ERROR_IO_PENDING)
      return tl::unexpected(EIO);
    if (GetOverlappedResult(system_->device, &system_->reading, &count, TRUE) == 0) return tl::unexpected(EIO);
    size += count;
  }
  if (!system_->wait_for_first()) return tl::unexpected(EIO);
  const std::string_view read(bytes.data(), size);
  constexpr DWORD kBad = CE_RXPARITY | CE_FRAME | CE_BREAK | CE_OVERRUN | CE_RXOVER;
  const std::string given = marks_ ? system_->replaced.mark(read, (errors & kBad) != 0) : std::string(read);
  return given.copy(into.data(), into.size());
}

tl::expected<size_t, int> Tty::write(std::string_view bytes) {
  DWORD count = 0;
  if (system_->writes) {
    if (GetOverlappedResult(system_->device, &system_->writing, &count, FALSE) == 0)
      return GetLastError() == ERROR_IO_INCOMPLETE ? tl::expected<size_t, int>(0) : tl::unexpected(EIO);
    system_->writes = false;
  }
  const size_t size = std::min(bytes.size(), kPiece);
  std::copy_n(bytes.begin(), size, system_->piece.begin());
  ResetEvent(system_->writing.hEvent);
  if (WriteFile(system_->device, system_->piece.data(), static_cast<DWORD>(size), &count,
                &system_->writing) == 0) {
    if (GetLastError() != ERROR_IO_PENDING) return tl::unexpected(EIO);
    system_->writes = true;
  }
  return size;
}

}  // namespace ipos::runtime
