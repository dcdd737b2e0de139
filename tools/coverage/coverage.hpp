// Which lines, branches and functions of IPOS sources were executed, as plain data by source file. Coverage
// of several runs, stations and programs of the same sources adds up.
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>

namespace ipos::tools::coverage {

struct Place {
  uint32_t line = 0;  // from 1; 0: not known
  uint32_t column = 0;

  auto operator<=>(const Place&) const = default;
};

// Something a program decides by one command: a comparison, or whether an input or event calls a function.
// Its two ways are the branches.
struct Condition {
  struct Way {
    Place to;  // what comes next this way
    uint64_t count = 0;
  };
  std::array<Way, 2> ways;  // on to the next command, then the jump

  bool tested() const { return ways[0].count != 0 || ways[1].count != 0; }
};

// Conditions of one place, as a macro may have several, are numbered.
struct ConditionKey {
  Place at;
  uint32_t number = 0;

  auto operator<=>(const ConditionKey&) const = default;
};

struct Function {
  uint32_t line = 0;   // of its first command
  uint64_t count = 0;  // calls, starts as a task and interrupts
};

struct SourceFile {
  std::map<uint32_t, uint64_t> lines;  // that have code, and how often each was executed
  std::map<ConditionKey, Condition> conditions;
  std::map<std::string, Function> functions;
};

struct Figure {
  size_t covered = 0;
  size_t all = 0;

  Figure& operator+=(const Figure& other);
  double rate() const;  // 0..1; of nothing 1
};

struct Figures {
  Figure lines, branches, functions;

  Figures& operator+=(const Figures& other);
};

struct Coverage {
  std::map<std::string, SourceFile> files;  // by the path the compiler was given

  void merge(const Coverage& other);

  // With the names as programs that read reports look for files: relative to `folder`,
  // which is a whole path without links; absolute where they lie elsewhere.
  Coverage named_from(const std::string& folder) const;
};

Figures figures(const SourceFile& file);
Figures figures(const Coverage& coverage);

}  // namespace ipos::tools::coverage
