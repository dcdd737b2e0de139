// The services of the parameter channel as data, from services.def: what a request asks of a parameter.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace ipos::stdlib {

// Codes of management bits 0-3; 9..15 are no service.
enum class Service : uint8_t {
#define SERVICE(name, code, text) name = code,
#include "stdlib/services.def"
};

std::optional<Service> service_from_code(uint32_t code);
std::string_view service_text(Service service);
constexpr bool is_write(Service service) {
  return service == Service::Write || service == Service::WriteVolatile;
}

}  // namespace ipos::stdlib
