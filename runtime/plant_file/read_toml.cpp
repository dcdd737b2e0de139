// The only place that calls the parser of toml++, so that no text reaches it unseen.
#include "runtime/plant_file/read_toml.hpp"

#include <utility>

#include "stdlib/plain_text.hpp"

namespace ipos::runtime {

namespace {

// The first text with control characters but tabs and line ends, or key with any: they would act on terminals and in
// reports, and no value here needs one.
std::optional<TomlError> unclean(const toml::node& node) {
  std::optional<TomlError> found;
  if (const toml::table* table = node.as_table()) {
    for (const auto& [key, value] : *table) {
      if (!stdlib::is_plain(key.str()))
        return TomlError{place_of(key.source()), "a key has no control characters"};
      if ((found = unclean(value))) return found;
    }
  } else if (const toml::array* array = node.as_array()) {
    for (const toml::node& value : *array)
      if ((found = unclean(value))) return found;
  } else if (const auto* text = node.as_string()) {
    std::string without(text->get());
    std::erase_if(without, [](char c) { return c == '\t' || c == '\n'; });
    if (!stdlib::is_plain(without)) return TomlError{place_of(node), "a text has no control characters"};
  }
  return found;
}

}  // namespace

tl::expected<toml::table, TomlError> read_toml(std::string_view text) {
  if (const auto mistake = toml_mistake(text))
    return tl::unexpected(TomlError{mistake->place, std::string(mistake->text)});
  toml::parse_result parsed = toml::parse(toml_for_parser(text));
  if (!parsed) {
    const std::string_view what = parsed.error().description();
    // The commonest one, in words: name = sbus.
    const bool no_value = what.find("could not determine value type") != std::string_view::npos;
    return tl::unexpected(
        TomlError{place_of(parsed.error().source()), std::string(no_value ? kWhatAValueIs : what)});
  }
  if (const auto found = unclean(parsed.table())) return tl::unexpected(*found);
  return std::move(parsed).table();
}

}  // namespace ipos::runtime
