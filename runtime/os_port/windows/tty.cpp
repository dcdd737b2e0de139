// A serial device of Windows. One piece of output at a time is on its way, so that nothing waits for the wire.
#include "runtime/os_port/tty.hpp"

#include <fmt/format.h>
#include <windows.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <utility>

namespace ipos::runtime {
namespace {

constexpr size_t kPiece = 512;

int error_number(DWORD error) {
  switch (error) {
    case ERROR_FILE_NOT_FOUND:
    case ERROR_PATH_NOT_FOUND: return ENOENT;
    case ERROR_ACCESS_DENIED:
    case ERROR_SHARING_VIOLATION:
      return EBUSY;  // another program has it; a serial device has no other rights
    case ERROR_INVALID_FUNCTION:
    case ERROR_INVALID_HANDLE: return ENOTTY;
    default: return EIO;
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
  wanted.fDtrControl = DTR_CONTROL_ENABLE;
  wanted.fRtsControl = way.rs485 ? RTS_CONTROL_TOGGLE : RTS_CONTROL_ENABLE;
  return SetCommState(device, &wanted) != 0;
}

}  // namespace

struct Tty::System {
  explicit System(HANDLE opened) : device(opened) {
    reading.hEvent = CreateEventW(nullptr, TRUE, FALSE, nullptr);
    writing.hEvent = CreateEventW(nullptr, TRUE, FALSE, nullptr);
  }
  ~System() {
    if (pending) finish_writing();
    if (has_former) SetCommState(device, &former);
    CloseHandle(device);
    CloseHandle(reading.hEvent);
    CloseHandle(writing.hEvent);
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

  HANDLE device;
  DCB former{};
  bool has_former = false;
  OVERLAPPED reading{};
  OVERLAPPED writing{};
  std::array<char, kPiece> piece{};
  bool pending = false;
};

Tty::Tty(std::unique_ptr<System> system) : system_(std::move(system)) {}
Tty::Tty(Tty&&) noexcept = default;
Tty::~Tty() = default;

int Tty::descriptor() const { return -1; }

tl::expected<Tty, PortError> Tty::open(const std::string& path, const TtySettings& settings,
                                       PortNotes& notes) {
  const std::wstring device = L"\\\\.\\" + std::wstring(path.begin(), path.end());
  const HANDLE opened = CreateFileW(device.c_str(), GENERIC_READ | GENERIC_WRITE, 0, nullptr, OPEN_EXISTING,
                                    FILE_FLAG_OVERLAPPED, nullptr);
  if (opened == INVALID_HANDLE_VALUE) return tl::unexpected(system_error(error_number(GetLastError()), path));
  auto system = std::make_unique<System>(opened);
  system->former.DCBlength = sizeof(DCB);
  if (GetCommState(opened, &system->former) == 0)
    return tl::unexpected(port_error(PortFault::NotSerial, path));
  system->has_former = true;
  const bool rs485 = settings.rs485, parity = settings.even_parity;
  const auto taken = std::find_if(std::begin(kWays), std::end(kWays), [&](const Way& way) {
    return way.rs485 <= rs485 && way.parity <= parity && set_state(opened, settings.baud, way);
  });
  if (taken == std::end(kWays))
    return tl::unexpected(port_error(PortFault::NoBaudRate, path, fmt::format("{} bit/s", settings.baud)));
  if (taken->rs485 != rs485)
    notes.note("the driver does not switch RS-485 direction: the adapter has to do it");
  // A read takes what is there and does not wait.
  COMMTIMEOUTS times{MAXDWORD, 0, 0, 0, 0};
  if (SetCommTimeouts(opened, &times) == 0)
    return tl::unexpected(system_error(error_number(GetLastError()), path));
  PurgeComm(opened, PURGE_RXCLEAR | PURGE_TXCLEAR);
  Tty tty(std::move(system));
  tty.parity_ = taken->parity;
  if (taken->parity != parity)
    notes.note("the device has no parity: neither sends it nor sees its errors");
  else if (parity)
    notes.note("Windows does not say which byte has a parity error: the block check has to find it");
  return tty;
}

// A driver may keep a read waiting for its first byte, whatever the times say: it is asked for what is there.
tl::expected<size_t, int> Tty::read(std::span<char> into) {
  DWORD count = 0, errors = 0;
  COMSTAT state{};
  if (ClearCommError(system_->device, &errors, &state) == 0)
    return tl::unexpected(error_number(GetLastError()));
  const auto most = static_cast<DWORD>(std::min<size_t>(into.size(), state.cbInQue));
  if (most == 0) return 0;
  const bool done = ReadFile(system_->device, into.data(), most, &count, &system_->reading) != 0;
  if (!done && GetLastError() != ERROR_IO_PENDING) return tl::unexpected(error_number(GetLastError()));
  if (!done && GetOverlappedResult(system_->device, &system_->reading, &count, TRUE) == 0)
    return tl::unexpected(error_number(GetLastError()));
  return count;
}

tl::expected<size_t, int> Tty::write(std::string_view bytes) {
  DWORD count = 0;
  if (system_->pending) {
    if (GetOverlappedResult(system_->device, &system_->writing, &count, FALSE) == 0)
      return GetLastError() == ERROR_IO_INCOMPLETE ? tl::expected<size_t, int>(0)
                                                   : tl::unexpected(error_number(GetLastError()));
    system_->pending = false;
  }
  const size_t size = std::min(bytes.size(), kPiece);
  std::copy_n(bytes.begin(), size, system_->piece.begin());
  ResetEvent(system_->writing.hEvent);
  if (WriteFile(system_->device, system_->piece.data(), static_cast<DWORD>(size), &count,
                &system_->writing) == 0) {
    if (GetLastError() != ERROR_IO_PENDING) return tl::unexpected(error_number(GetLastError()));
    system_->pending = true;
  }
  return size;
}

}  // namespace ipos::runtime
