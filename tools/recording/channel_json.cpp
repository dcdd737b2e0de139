// What says nothing is left out.
#include "tools/recording/channel_json.hpp"

namespace ipos::tools {

nlohmann::json channel_json(const signals::Signal& signal) {
  const signals::Shape shape = signals::shape_of(signal);
  nlohmann::json json{{"name", signal.name},
                      {"unit", signal.unit},
                      {"decimals", signal.decimals},
                      {"bits", signal.bits},
                      {"kind", signals::kind_text(shape.kind)}};
  for (const auto& [bit, text] : shape.bits) json["bit_names"].push_back({bit, text});
  for (const auto& [value, text] : shape.texts) json["texts"].push_back({value, text});
  if (shape.mask != -1) json["mask"] = shape.mask;
  return json;
}

}  // namespace ipos::tools
