// The only place that calls the parser of toml++, so that no text reaches it unseen.
#include "runtime/plant_file/read_toml.hpp"

#include <utility>

namespace ipos::runtime {

tl::expected<toml::table, TomlError> read_toml(std::string_view text) {
  if (const auto mistake = toml_mistake(text))
    return tl::unexpected(TomlError{mistake->place, std::string(mistake->text)});
  toml::parse_result parsed = toml::parse(text);
  if (!parsed) {
    const std::string_view what = parsed.error().description();
    // The commonest one, in words: name = sbus.
    const bool no_value = what.find("could not determine value type") != std::string_view::npos;
    return tl::unexpected(
        TomlError{place_of(parsed.error().source()), std::string(no_value ? kWhatAValueIs : what)});
  }
  return std::move(parsed).table();
}

}  // namespace ipos::runtime
