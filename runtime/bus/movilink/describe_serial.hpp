// Telegrams of RS-485 in words and units, as describe.hpp does it for SBus. The dictionary has P810 as
// address and P811 as group of its units.
#pragma once

#include <string>

#include "runtime/bus/movilink/describe.hpp"
#include "runtime/bus/movilink/serial_receiver.hpp"

namespace ipos::runtime {

// "3PD cyclic, PO CTRL. WORD 1 0006h, SPEED 1000.0 rpm, 0000h -> unit1"
std::string describe(const TelegramNames& names, const SerialTelegram& telegram);

// The telegram, or why there is none and its bytes: "void, BCC incorrect: 02 01 05"
std::string describe(const TelegramNames& names, const Reception& reception);

}  // namespace ipos::runtime
