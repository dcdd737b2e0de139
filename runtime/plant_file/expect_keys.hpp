// Keys of an [[expect]]: those that every reader of a plant knows, and those that only `ipos test` looks at; and what a test has
// beside the tables of a plant.
#pragma once

#include <string_view>
#include <vector>

namespace ipos::runtime {

inline const std::vector<std::string_view> kExpectKeys = {"station", "at",    "variable", "parameter", "input",
                                                          "output",  "state", "signal",   "equals"};

inline const std::vector<std::string_view> kTestExpectKeys = {
    "after",  "note",     "process_data", "bus",    "frame",  "telegram", "not",   "min",      "max",
    "one_of", "tolerance", "within",      "during", "always", "never",    "times", "at_least", "at_most",
    "every",  "sequence", "repeat"};

// Keys of a test file beside those of a plant.
inline const std::vector<std::string_view> kTestKeys = {"plant", "plant_expects", "by_hand", "speed",
                                                        "step",  "expect",        "case"};

}  // namespace ipos::runtime
