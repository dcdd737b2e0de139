// Units, types, variables and structure, in the order of the schemas of both versions.
#include "tools/fmu/description.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "tools/cli/xml_text.hpp"
#include "tools/fmu/bus_terminals.hpp"

namespace ipos::tools {
namespace {

using fmi::Causality;
using fmi::Type;
using fmi::Variable;
using fmi::Variables;

constexpr std::string_view kCausalities[] = {"input", "output", "parameter", "local"};
constexpr std::string_view kTimeUnit = "s";

// By value reference - 1; 0 is the time, which stands first.
class Writer {
 public:
  Writer(const Dialect& dialect, const Variables& variables, const fmi::Terminals& terminals)
      : dialect_(dialect), variables_(variables), terminals_(terminals) {}

  std::string write(const DescriptionHead& head) {
    line("<?xml version=\"1.0\" encoding=\"UTF-8\"?>");
    line("<fmiModelDescription fmiVersion=\"{}\" modelName=\"{}\" {}=\"{}\" generationTool=\"ipos {}\" "
         "variableNamingConvention=\"structured\">",
         dialect_.version, xml_attribute(head.model), dialect_.token, xml_attribute(head.token), IPOS_VERSION);
    line("  <CoSimulation modelIdentifier=\"{}\" canHandleVariableCommunicationStepSize=\"true\" {}=\"true\" {}=\"true\"{}/>",
         head.identifier, dialect_.get_state, dialect_.serialize, head.is_line ? dialect_.more_of_a_line : dialect_.more);
    write_units();
    write_types();
    line("  <LogCategories>");
    line("    <Category name=\"logStatusError\" description=\"calls that are wrong\"/>");
    line("    <Category name=\"logStatusWarning\" description=\"values that a unit refuses\"/>");
    line("    <Category name=\"journal\" description=\"what the plant tells its user\"/>");
    line("  </LogCategories>");
    line("  <DefaultExperiment startTime=\"0\" stopTime=\"1\" stepSize=\"0.001\"/>");
    line("  <ModelVariables>");
    write_time();
    for (size_t n = 0; n < variables_.all.size(); ++n) write_variable(variables_.all[n], n + 1);
    for (size_t n = 0; n < terminals_.size(); ++n) write_terminal(*terminals_[n], first_member(n));
    line("  </ModelVariables>");
    write_structure();
    line("</fmiModelDescription>");
    return std::move(out_);
  }

 private:
  template <typename... Values>
  void line(fmt::format_string<Values...> form, Values&&... values) {
    out_ += fmt::format(form, std::forward<Values>(values)...);
    out_ += '\n';
  }

  void write_units() {
    line("  <UnitDefinitions>");
    bool has_time = false;
    for (const runtime::PhysicalUnit& unit : variables_.units) {
      write_unit(unit);
      has_time |= unit.name == kTimeUnit;
    }
    if (!has_time) write_unit(*signals::find_physical_unit(kTimeUnit));
    line("  </UnitDefinitions>");
  }
  void write_unit(const runtime::PhysicalUnit& unit) {
    constexpr std::string_view kBases[] = {"kg", "m", "s", "A", "K", "mol", "cd", "rad"};
    std::string base;
    for (size_t n = 0; n < std::size(kBases); ++n)
      if (unit.exponents[n] != 0) base += fmt::format(" {}=\"{}\"", kBases[n], unit.exponents[n]);
    if (unit.factor != 1) base += fmt::format(" factor=\"{}\"", unit.factor);
    if (unit.offset != 0) base += fmt::format(" offset=\"{}\"", unit.offset);
    line("    <Unit name=\"{}\"><BaseUnit{}/></Unit>", xml_attribute(unit.name), base);
  }

  void write_types() {
    if (variables_.enumerations.empty()) return;
    line("  <TypeDefinitions>");
    for (const fmi::Enumeration& type : variables_.enumerations) {
      if (dialect_.nested)
        line("    <SimpleType name=\"{}\"><Enumeration>", xml_attribute(type.name));
      else
        line("    <EnumerationType name=\"{}\">", xml_attribute(type.name));
      for (const auto& [value, text] : type.items) line("      <Item name=\"{}\" value=\"{}\"/>", xml_attribute(text), value);
      line("{}", dialect_.nested ? "    </Enumeration></SimpleType>" : "    </EnumerationType>");
    }
    line("  </TypeDefinitions>");
  }

  void write_element(std::string_view head, std::string_view type, std::string_view attributes) {
    if (dialect_.nested)
      line("    <ScalarVariable{}><{}{}/></ScalarVariable>", head, type, attributes);
    else
      line("    <{}{}{}/>", type, head, attributes);
  }

  void write_time() {
    write_element(" name=\"time\" valueReference=\"0\" causality=\"independent\" variability=\"continuous\"", type_name(Type::Real),
                  fmt::format(" unit=\"{}\"", kTimeUnit));
  }

  void write_variable(const Variable& variable, size_t reference) {
    std::string head = fmt::format(" name=\"{}\" valueReference=\"{}\"", xml_attribute(variable.name), reference);
    if (!variable.description.empty()) head += fmt::format(" description=\"{}\"", xml_attribute(variable.description));
    head += fmt::format(" causality=\"{}\" variability=\"{}\"", kCausalities[static_cast<size_t>(variable.causality)],
                        variable.causality == Causality::Parameter ? "tunable"
                        : variable.is_continuous                   ? "continuous"
                                                                   : "discrete");
    // Of an input FMI 2.0 wants no word of it.
    if (variable.causality != Causality::Input)
      head += fmt::format(" initial=\"{}\"", variable.is_settable() ? "exact" : "calculated");
    std::string attributes;
    if (variable.enumeration)
      attributes = fmt::format(" declaredType=\"{}\"", xml_attribute(variables_.enumerations[*variable.enumeration].name));
    if (!variable.unit.empty()) attributes += fmt::format(" unit=\"{}\"", xml_attribute(variable.unit));
    if (variable.range)
      attributes += fmt::format(" min=\"{}\" max=\"{}\"", number(variable, variable.range->first),
                                number(variable, variable.range->second));
    if (variable.is_settable()) attributes += fmt::format(" start=\"{}\"", number(variable, variable.signal.read()));
    write_element(head, type_name(variable.type), attributes);
  }

  size_t first_member(size_t terminal) const { return variables_.all.size() + 1 + terminal * fmi::kTerminalMembers; }

  void write_terminal(const fmi::BusTerminal& terminal, size_t first) {
    using enum fmi::TerminalMember;
    const auto name = [&](fmi::TerminalMember member) { return xml_attribute(member_name(terminal, member)); };
    constexpr std::string_view kMime = "mimeType=\"application/org.fmi-standard.fmi-ls-bus.can; version=&quot;1.0.0&quot;\"";
    line("    <Binary name=\"{}\" valueReference=\"{}\" causality=\"input\" variability=\"discrete\" clocks=\"{}\" {}><Start value=\"\"/></Binary>",
         name(RxData), first, first + 2, kMime);
    line("    <Binary name=\"{}\" valueReference=\"{}\" causality=\"output\" variability=\"discrete\" initial=\"calculated\" clocks=\"{}\" {}/>",
         name(TxData), first + 1, first + 3, kMime);
    line("    <Clock name=\"{}\" valueReference=\"{}\" causality=\"input\" intervalVariability=\"triggered\"/>", name(RxClock), first + 2);
    const bool is_of_the_line = terminal.is_of_the_line();
    line("    <Clock name=\"{}\" valueReference=\"{}\" {}/>", name(TxClock), first + 3,
         is_of_the_line ? "causality=\"input\" intervalVariability=\"countdown\" supportsFraction=\"true\""
                        : "causality=\"output\" intervalVariability=\"triggered\"");
    line("    <Boolean name=\"{}\" valueReference=\"{}\" {}/>", name(BusNotifications), first + 4,
         is_of_the_line ? "causality=\"output\" variability=\"constant\" start=\"true\""
                        : "causality=\"parameter\" variability=\"fixed\" start=\"false\"");
  }

  void write_structure() {
    line("  <ModelStructure>");
    if (dialect_.nested) {
      write_unknowns("Outputs", " dependencies=\"\"");
      write_unknowns("InitialUnknowns", "");
    } else {
      // What is set at a communication point acts in the step that follows: no output depends on an input of its time.
      for_each_output([&](size_t n) { line("    <Output valueReference=\"{}\" dependencies=\"\"/>", n + 1); });
      using enum fmi::TerminalMember;
      for_each_member(TxData, [&](bool, size_t member) { line("    <Output valueReference=\"{}\"/>", member); });
      for_each_member(TxClock, [&](bool of_the_line, size_t member) {
        if (!of_the_line) line("    <Output valueReference=\"{}\"/>", member);
      });
      for_each_member(BusNotifications, [&](bool of_the_line, size_t member) {
        if (of_the_line) line("    <Output valueReference=\"{}\"/>", member);
      });
      for_each_output([&](size_t n) { line("    <InitialUnknown valueReference=\"{}\"/>", n + 1); });
      for_each_member(TxClock, [&](bool of_the_line, size_t member) {
        if (!of_the_line) line("    <InitialUnknown valueReference=\"{}\"/>", member);
      });
    }
    line("  </ModelStructure>");
  }
  template <typename Do>
  void for_each_member(fmi::TerminalMember member, Do action) {
    for (size_t n = 0; n < terminals_.size(); ++n)
      action(terminals_[n]->is_of_the_line(), first_member(n) + static_cast<size_t>(member));
  }
  // FMI 2.0 counts the variables from 1, the time among them.
  void write_unknowns(std::string_view element, std::string_view attributes) {
    line("    <{}>", element);
    for_each_output([&](size_t n) { line("      <Unknown index=\"{}\"{}/>", n + 2, attributes); });
    line("    </{}>", element);
  }
  template <typename Do>
  void for_each_output(Do action) {
    for (size_t n = 0; n < variables_.all.size(); ++n)
      if (variables_.all[n].causality == Causality::Output) action(n);
  }

  std::string_view type_name(Type type) const { return dialect_.types[static_cast<size_t>(type)]; }
  static std::string number(const Variable& variable, int64_t sample) {
    if (variable.type == Type::Real) return fmt::format("{}", variable.value_of(sample));
    if (variable.type == Type::Boolean) return sample != 0 ? "true" : "false";
    return fmt::format("{}", sample);
  }

  const Dialect& dialect_;
  const Variables& variables_;
  const fmi::Terminals& terminals_;
  std::string out_;
};

}  // namespace

std::string description_of(const Dialect& dialect, const DescriptionHead& head, const fmi::Variables& variables,
                           const fmi::Terminals& terminals) {
  return Writer(dialect, variables, terminals).write(head);
}

}  // namespace ipos::tools
