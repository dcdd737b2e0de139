// The parts that telegrams of SBus and RS-485 have in common, in words and units: the parameter channel and
// process data words. Names and scales are those of the unit, without one of MOVIDRIVE MD_60A.
#pragma once

#include <span>
#include <string>

#include "runtime/bus/movilink/describe.hpp"
#include "runtime/bus/movilink/parameter_telegram.hpp"

namespace ipos::runtime {

// "write 8470 Ramp t11 UP CW = 3.000 s"; without bit 6 of the management byte, whose meaning depends on the
// bus.
std::string parameter_words(const UnitNames* unit, const ParameterTelegram& telegram, bool request);

// "PI STATUS WORD1 0007h, SPEED 1002.2 rpm" after `what`; without a unit in hexadecimal.
std::string process_words_text(const UnitNames* unit, const std::string& what, bool input,
                               std::span<const uint16_t> words);

}  // namespace ipos::runtime
