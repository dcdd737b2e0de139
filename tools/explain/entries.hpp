// What `ipos explain` can explain: a row for each thing the tools print by a short name. The rows come from the tables that
// compiler, drive and planner read; the long texts of messages and functions come from the pages of docs/reference.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace ipos::tools::explain {

struct Entry {
  std::vector<std::string> names;  // as the tools print it first: "H511", "ActPos_Mot", "ACTPOS.MOT"
  std::string title;               // one line
  std::function<std::string()> text;
};

using Entries = std::vector<Entry>;

void add_messages(Entries& entries);  // of the compiler, the verifier and the planner
void add_language(Entries& entries);  // functions, structures, variables, constants, commands
void add_drive(Entries& entries);     // faults, parameters, return codes
void add_fieldbus(Entries& entries);  // CANopen and PROFIBUS
void add_shown(Entries& entries);     // units, display, words, texts of settings
Entries all_entries();

// What numbers mean that have no name of their own. Empty: nothing.
std::string parameter_of_index(std::string_view number);  // "8470"
std::string return_code(std::string_view number);         // "8/0/10", "0x08000010", "134217744"
std::string list_faults();
std::string status_word(const std::string& printed);  // "0503h": what the bits say
// Of hexadecimal numbers as logs print them, in one word or several: the name their entry has, "1017h" or "06020000h".
std::string printed_number(const std::vector<std::string>& words);
std::string parameter_of_object(const std::string& printed);  // "2070h"

// A page for the terminal: no marks of Markdown, no links that run, programs indented.
std::string plain_text(std::string_view page);

}  // namespace ipos::tools::explain
