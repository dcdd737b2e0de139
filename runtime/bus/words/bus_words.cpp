// Each kind of line has its own words; here they are together.
#include "runtime/bus/words/bus_words.hpp"

#include <fmt/format.h>

#include <utility>

#include "runtime/bus/movilink/describe_serial.hpp"
#include "runtime/bus/profibus/frame_text.hpp"

namespace ipos::runtime {

BusWords::BusWords(BusNames names) : can_(std::move(names.can)), serial_(std::move(names.serial)) {}

void BusWords::use(BusNames names) {
  can_.use(std::move(names.can));
  serial_ = std::move(names.serial);
}

std::string BusWords::describe(const Reception& reception) const {
  return runtime::describe(serial_, reception);
}

std::string BusWords::describe(const profibus::Reception& reception) const {
  if (reception.frame) return profibus::describe(*reception.frame);
  return fmt::format("void, {}: {}", profibus::frame_error_text(reception.frame.error()),
                     profibus::hex_text(reception.octets));
}

}  // namespace ipos::runtime
