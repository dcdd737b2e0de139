// Services from their table.
#include "stdlib/services.hpp"

namespace ipos::stdlib {
namespace {

struct Row {
  Service service;
  std::string_view text;
};

constexpr Row kServices[] = {
#define SERVICE(name, code, text) {Service::name, text},
#include "stdlib/services.def"
};

}  // namespace

std::optional<Service> service_from_code(uint32_t code) {
  for (const Row& row : kServices)
    if (static_cast<uint32_t>(row.service) == code) return row.service;
  return std::nullopt;
}

std::string_view service_text(Service service) {
  for (const Row& row : kServices)
    if (row.service == service) return row.text;
  return {};
}

}  // namespace ipos::stdlib
