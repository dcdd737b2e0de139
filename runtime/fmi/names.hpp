// Names of signals as FMI's naming convention "structured" wants them (FMI 2.0.5 chapter 2.2.9, FMI 3.0 chapter 2.4.7.5.1):
// identifiers of letters, digits and _ joined by dots, with indices; anything else in apostrophes.
#pragma once

#include <string>
#include <string_view>

namespace ipos::fmi {

// "unit1.PO1.6" becomes "unit1.'PO1.6'": what is no identifier goes with the one before it into apostrophes. The station's name is
// `owner`, with which the signal's begins. A letter that may not stand in apostrophes either becomes {hexadecimal}.
std::string structured_name(std::string_view owner, std::string_view signal);

}  // namespace ipos::fmi
