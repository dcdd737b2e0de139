// A port that may go away and come back: an adapter that is pulled out and put in again. While it is away it keeps its
// place at the line, what is sent to it is lost and counted, and it is opened by its name again and again. For runs
// that go on without their ports.
#pragma once

#include <functional>
#include <memory>

#include "runtime/os_port/can_port.hpp"
#include "runtime/os_port/serial_port.hpp"

namespace ipos::runtime {

// From one attempt to open it to the next (ours).
inline constexpr Time kReopenPause = kSecond;

// Opens a port; the same name and settings each time.
using OpenCanPort = std::function<CanPortResult()>;
using OpenSerialPort = std::function<SerialPortResult()>;

// The port as `open` gives it now, or why there is none. A pseudo-terminal by its number, /dev/pts/3, does not come
// back: the system may have given the number to another one meanwhile. The clock must outlive the port.
CanPortResult open_returning(OpenCanPort open, RealClock& clock);
SerialPortResult open_returning(OpenSerialPort open, RealClock& clock);

}  // namespace ipos::runtime
