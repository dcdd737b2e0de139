// Element by element, with expat.
#include "runtime/fmi_import/description.hpp"

#include <expat.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <memory>

#include "stdlib/plain_text.hpp"

namespace ipos::fmi_import {
namespace {

// As FMI 3.0 names them (section 2.4.7); an enumeration is its number.
struct TypeName {
  std::string_view name;
  std::optional<ipos_fmu_type> type;
};
constexpr TypeName kTypes[] = {{"Float64", IPOS_FMU_FLOAT64}, {"Float32", IPOS_FMU_FLOAT32}, {"Int8", IPOS_FMU_INT8},
                               {"UInt8", IPOS_FMU_UINT8},     {"Int16", IPOS_FMU_INT16},     {"UInt16", IPOS_FMU_UINT16},
                               {"Int32", IPOS_FMU_INT32},     {"UInt32", IPOS_FMU_UINT32},   {"Int64", IPOS_FMU_INT64},
                               {"UInt64", IPOS_FMU_UINT64},   {"Boolean", IPOS_FMU_BOOLEAN}, {"Enumeration", IPOS_FMU_INT64},
                               {"String", std::nullopt},      {"Binary", std::nullopt},      {"Clock", std::nullopt}};
// Those of FMI 2.0, inside of a ScalarVariable (section 2.2.7).
constexpr TypeName kTypesOfTwo[] = {{"Real", IPOS_FMU_FLOAT64},
                                    {"Integer", IPOS_FMU_INT32},
                                    {"Boolean", IPOS_FMU_BOOLEAN},
                                    {"Enumeration", IPOS_FMU_INT32},
                                    {"String", std::nullopt}};

constexpr std::array<std::string_view, 8> kBaseUnits{"kg", "m", "s", "A", "K", "mol", "cd", "rad"};

template <size_t size>
const TypeName* find_type(const TypeName (&types)[size], std::string_view name) {
  const auto found = std::find_if(types, types + size, [name](const TypeName& row) { return row.name == name; });
  return found == types + size ? nullptr : found;
}

class Attributes {
 public:
  explicit Attributes(const char** pairs) : pairs_(pairs) {}
  std::string_view text(std::string_view name, std::string_view otherwise = {}) const {
    for (const char** pair = pairs_; pair[0] != nullptr; pair += 2)
      if (name == pair[0]) return pair[1];
    return otherwise;
  }
  bool flag(std::string_view name) const { return text(name) == "true" || text(name) == "1"; }
  // Nothing where it is no number.
  template <typename Number>
  std::optional<Number> number(std::string_view name) const {
    std::string_view written = text(name);
    if (written.starts_with('+')) written.remove_prefix(1);
    Number value = 0;
    const auto [end, status] = std::from_chars(written.data(), written.data() + written.size(), value);
    if (written.empty() || status != std::errc() || end != written.data() + written.size()) return std::nullopt;
    return value;
  }

 private:
  const char** pairs_;
};

class Reader {
 public:
  Reader() : parser_(XML_ParserCreate(nullptr), XML_ParserFree) {
    XML_SetUserData(parser_.get(), this);
    XML_SetElementHandler(
        parser_.get(), [](void* self, const char* name, const char** pairs) { static_cast<Reader*>(self)->begin(name, Attributes(pairs)); },
        [](void* self, const char*) { static_cast<Reader*>(self)->path_.pop_back(); });
    // Entities of its own could make a large text of a small one.
    XML_SetStartDoctypeDeclHandler(parser_.get(), [](void* self, const char*, const char*, const char*, int) {
      static_cast<Reader*>(self)->refuse("has a document type of its own");
    });
  }

  tl::expected<Description, std::string> read(std::string_view xml) {
    const auto status = XML_Parse(parser_.get(), xml.data(), static_cast<int>(xml.size()), XML_TRUE);
    if (why_.empty() && status != XML_STATUS_OK)
      why_ = fmt::format("is no XML: {} in line {}", XML_ErrorString(XML_GetErrorCode(parser_.get())),
                         XML_GetCurrentLineNumber(parser_.get()));
    if (why_.empty()) check();
    if (!why_.empty()) return tl::unexpected("modelDescription.xml " + why_);
    resolve_types();
    return std::move(description_);
  }

 private:
  static constexpr size_t kDeepest = 64;  // ours

  void refuse(std::string why) {
    if (why_.empty()) why_ = std::move(why);
    XML_StopParser(parser_.get(), XML_FALSE);
  }
  bool within(std::string_view parent) const { return !path_.empty() && path_.back() == parent; }

  void begin(std::string_view name, const Attributes& attributes) {
    if (path_.size() == kDeepest) return refuse("nests too deeply");
    if (path_.empty())
      root(name, attributes);
    else if (name == "CoSimulation" && path_.size() == 1)
      co_simulation(attributes);
    else if (name == "Unit" && within("UnitDefinitions"))
      unit(attributes);
    else if (name == "BaseUnit" && within("Unit"))
      base_unit(attributes);
    else if (within("TypeDefinitions") || within("SimpleType"))
      type(name, attributes);
    else if (within("ModelVariables"))
      variable(name, attributes);
    else if (within("ScalarVariable"))
      type_of_two(name, attributes);
    else if (name == "Alias" && path_.size() == 3 && !description_.variables.empty())
      alias(attributes);
    else if (name == "Dimension" && !description_.variables.empty())
      description_.variables.back().is_array = true;
    path_.emplace_back(name);
  }

  void root(std::string_view name, const Attributes& attributes) {
    const std::string_view version = attributes.text("fmiVersion");
    if (name != "fmiModelDescription") return refuse("describes no FMU");
    description_.version = version.starts_with("2.") ? 2 : version.starts_with("3.") ? 3 : 0;
    if (description_.version == 0) return refuse(fmt::format("is of FMI {}; ipos knows 2.0 and 3.0", plain(version)));
    description_.model = plain(attributes.text("modelName"));
    description_.token = attributes.text(description_.version == 2 ? "guid" : "instantiationToken");
  }

  void co_simulation(const Attributes& attributes) {
    const bool second = description_.version == 2;
    description_.identifier = attributes.text("modelIdentifier");
    description_.needs_tool = attributes.flag("needsExecutionTool");
    description_.gives_state = attributes.flag(second ? "canGetAndSetFMUstate" : "canGetAndSetFMUState") &&
                               attributes.flag(second ? "canSerializeFMUstate" : "canSerializeFMUState");
    description_.fixed_step = attributes.number<double>("fixedInternalStepSize").value_or(0);
  }

  void unit(const Attributes& attributes) {
    unit_ = attributes.text("name");
    description_.units[unit_] = std::nullopt;
  }

  void base_unit(const Attributes& attributes) {
    runtime::PhysicalUnit unit;
    unit.name = plain(unit_);
    for (size_t n = 0; n < kBaseUnits.size(); ++n) unit.exponents[n] = attributes.number<int8_t>(kBaseUnits[n]).value_or(0);
    unit.factor = attributes.number<double>("factor").value_or(1);
    unit.offset = attributes.number<double>("offset").value_or(0);
    if (std::isfinite(unit.factor) && unit.factor != 0 && std::isfinite(unit.offset)) description_.units[unit_] = unit;
  }

  // In FMI 2.0 the unit stands in an element below, in FMI 3.0 in the type itself.
  void type(std::string_view name, const Attributes& attributes) {
    if (within("TypeDefinitions")) type_ = attributes.text("name");
    if (const auto unit = attributes.text("unit"); !unit.empty() && name != "SimpleType") units_of_types_[type_] = unit;
  }

  void variable(std::string_view name, const Attributes& attributes) {
    const TypeName* type = description_.version == 3 ? find_type(kTypes, name) : nullptr;
    if (type == nullptr && (description_.version == 3 || name != "ScalarVariable")) return;  // a Tool's own
    if (description_.variables.size() == Description::kMostVariables) return refuse("has too many variables");
    Variable& added = description_.variables.emplace_back();
    added.name = attributes.text("name");
    const auto reference = attributes.number<uint32_t>("valueReference");
    if (!reference || added.name.empty()) return refuse("has a variable without a name or a reference");
    added.reference = *reference;
    added.causality = attributes.text("causality", "local");
    added.variability = attributes.text("variability");
    added.initial = attributes.text("initial");
    if (type != nullptr) added.type = type->type;
    take_type(added, attributes);
  }

  void type_of_two(std::string_view name, const Attributes& attributes) {
    const TypeName* type = find_type(kTypesOfTwo, name);
    if (type == nullptr) return;
    description_.variables.back().type = type->type;
    take_type(description_.variables.back(), attributes);
  }

  // Another name of the variable before it (FMI 3.0 section 2.4.7.5).
  void alias(const Attributes& attributes) {
    if (description_.variables.size() == Description::kMostVariables) return refuse("has too many variables");
    Variable other = description_.variables.back();
    other.name = attributes.text("name");
    description_.variables.push_back(std::move(other));
  }

  static void take_type(Variable& variable, const Attributes& attributes) {
    if (const auto unit = attributes.text("unit"); !unit.empty()) variable.unit = unit;
    if (const auto type = attributes.text("declaredType"); !type.empty()) variable.declared_type = type;
  }

  void resolve_types() {
    for (Variable& variable : description_.variables)
      if (const auto found = units_of_types_.find(variable.declared_type); variable.unit.empty() && found != units_of_types_.end())
        variable.unit = found->second;
  }

  // The identifier becomes the name of a file.
  void check() {
    const std::string& name = description_.identifier;
    const auto is_letter = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; };
    if (name.empty())
      why_ = "has no CoSimulation: ipos steps FMUs that bring their own solver";
    else if (!std::all_of(name.begin(), name.end(), is_letter))
      why_ = "has a modelIdentifier that is no name of C";
  }

  static std::string plain(std::string_view text) { return stdlib::is_plain(text) ? std::string(text) : "?"; }

  std::unique_ptr<XML_ParserStruct, void (*)(XML_Parser)> parser_;
  std::vector<std::string> path_;
  Description description_;
  std::string unit_, type_;
  std::map<std::string, std::string> units_of_types_;
  std::string why_;
};

}  // namespace

tl::expected<Description, std::string> read_description(std::string_view xml) { return Reader().read(xml); }

}  // namespace ipos::fmi_import
