// The parameter lists of the units as data, from parameters/*.tsv.
//
// A row is a line of the printed list. Several lines may show one index (P031 and P600): then one of them
// leads and decides access, range, default and coding, and the others are views that differ in number, name
// and display only. find(index) gives the leading row, find("P031") the row of that number; both carry the
// leading row's rules, but a view may name the values in its own words (texts).
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "stdlib/return_codes.hpp"
#include "stdlib/unit_types.hpp"

namespace ipos::stdlib {

// Values from minimum to maximum that are minimum + n x step. 64 bits because some parameters are unsigned.
struct ValueRange {
  int64_t minimum;
  int64_t maximum;
  int64_t step;
};

struct ValueText {
  int32_t value;
  std::string_view text;
  bool logodrive_only;
  // Firmware version that knows it first, of the standard unit and of LOGODrive; 0: every one.
  uint8_t from_standard = 0;
  uint8_t from_logodrive = 0;
};

// Card without which the parameter cannot be written; such parameters exist on MD_60A and MDX only.
enum class OptionCard : uint8_t { None, Drs, Dio, Aio };

// Who may write a parameter, when, and what becomes of it.
struct ParameterRules {
  bool writable = false;                // RW
  bool needs_inhibit = false;           // R: written only under controller inhibit
  bool writable_locked = false;         // S: written also under parameter lock
  bool nonvolatile = false;             // N: from EEPROM at restart
  bool needs_output_stage_off = false;  // E, ours
  bool bcd = false;                     // B, ours: travels as 4-byte BCD (0922 6818, 3.7.5)
  OptionCard option = OptionCard::None;
};

struct Parameter : ParameterRules {
  std::string_view number;  // "813"; empty when none is printed
  std::string_view name;
  uint16_t index = 0;  // 0: a keypad setting without index
  bool view = false;   // another row leads this index

  int64_t default_value = 0;
  std::span<const ValueRange> ranges;  // empty: texts decide, or any value when there are none either
  std::span<const ValueText> texts;    // in rising order

  uint8_t quantity = 0;  // 255 = none given
  int8_t conversion = 0;
  std::string_view display;  // unit shown to people; "hex" for bit fields, "firmware", "ascii"
  std::string_view notes;    // doubts about the printed row and what was taken

  // Limits by ranges, else texts, else all 32 bits. Above 2^31 the transferred bits count as unsigned.
  int64_t minimum() const;
  int64_t maximum() const;
  bool is_unsigned() const { return maximum() > INT32_MAX; }
  // The transferred 32 bits as a number of this parameter.
  int64_t number_of(int32_t bits) const {
    return is_unsigned() ? int64_t{static_cast<uint32_t>(bits)} : bits;
  }
};

struct ParameterList;  // parameter_list.hpp

class ParameterTable {
 public:
  // Rows of `lists` in order; a row of a later list replaces those of the same number. Without `option_cards`
  // the rows that need one are left out. The texts of the lists must outlive the table.
  ParameterTable(std::span<const ParameterList> lists, bool option_cards);
  ParameterTable(const ParameterTable&) = delete;
  ParameterTable& operator=(const ParameterTable&) = delete;

  std::span<const Parameter> rows() const { return rows_; }
  // The leading rows in rising order of their indices.
  std::span<const Parameter* const> by_index() const { return by_index_; }
  // Faults of the text; empty unless a list was edited badly.
  std::span<const std::string> problems() const { return problems_; }

  // nullptr when there is none. By text: "P813", "813", or an index such as "8600".
  const Parameter* find(uint16_t index) const;
  const Parameter* find(std::string_view text) const;

 private:
  void take(const ParameterList& list, bool replaces);

  std::vector<Parameter> rows_;
  std::vector<std::vector<ValueText>> texts_;  // of each list
  std::vector<std::vector<ValueRange>> ranges_;
  std::vector<const Parameter*> by_index_;
  std::vector<const Parameter*> by_number_;
  std::vector<const Parameter*> by_digits_;  // of the numbers 000 to 999, which most have
  std::vector<std::string> problems_;
};

// The list of a unit, read on first use; empty for units without one.
const ParameterTable& parameter_table(const UnitType& unit);

// Number shown = transferred number x factor, with so many decimals. The offsets of temperatures cancel: they
// are transferred and shown in one unit.
struct DisplayScale {
  double factor;
  int decimals;
};
DisplayScale display_scale(const Parameter& parameter);

// The value as people read it: "2.000 s", "CTRL. WORD 1", "0x0202".
std::string parameter_text(const Parameter& parameter, int32_t value);

// What it takes as people read it: "0.000 s..2000.000 s", "0 = OFF or 1 = ON"; empty: any value.
std::string parameter_range(const Parameter& parameter);

// The transferred value of such a text. The unit may be left out or be another one of the quantity ("2500
// ms"); a value of a list may be named by text, in any case of letters, or by code. The error says what would
// be accepted. Whether the value is in range is the unit's to say.
tl::expected<int32_t, std::string> parse_parameter_text(const Parameter& parameter, std::string_view text);

// What an index is called: "P130 Ramp t11 UP CW", "H20", "program word 5", "curve point 3", "index 9500".
std::string index_name(const ParameterTable& table, uint16_t index);

// Why a service was refused: "P813 SBus address := 64: parameter value too large (0..63)".
std::string explain_refusal(const ParameterTable& table, uint8_t service, uint16_t index, int32_t value,
                            ReturnCode code);

}  // namespace ipos::stdlib
