// A small interpreter of STEP 5 statement lists, enough for the program example of the manual: bits and words of
// inputs, outputs, peripherals and markers, conditional jumps and block calls with formal operands. Operands
// may be German or English. Load and transfer leave the result of logic operation (RLO) alone; a conditional
// jump or end that is not executed sets it to 1.
#pragma once

#include <cstdint>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace ipos::tests {

class Step5 {
 public:
  // A line is "LABEL: OPERATION OPERAND", the label with its colon only where there is one.
  void load(const std::string& block, const std::string& text) {
    std::istringstream lines(text);
    std::string line;
    std::vector<Statement>& program = blocks_[block];
    program.clear();
    while (std::getline(lines, line)) {
      Statement statement;
      std::istringstream words(line);
      std::string word;
      while (words >> word) statement.words.push_back(word);
      if (statement.words.empty()) continue;
      if (statement.words[0].back() == ':') {
        statement.label = statement.words[0].substr(0, statement.words[0].size() - 1);
        statement.words.erase(statement.words.begin());
      }
      const auto known = operations().find(statement.words.at(0));
      if (known == operations().end()) throw std::runtime_error("no such operation: " + line);
      statement.words[0] = known->second;
      program.push_back(statement);
    }
  }

  // One cycle of the program.
  void run(const std::string& block, const std::map<std::string, std::string>& formals = {}) {
    execute(block, formals);
  }

  bool bit(const std::string& area, int octet, int number) { return (areas[area][octet] >> number & 1) != 0; }
  void set_bit(const std::string& area, int octet, int number, bool on) {
    uint8_t& value = areas[area][octet];
    value = static_cast<uint8_t>(on ? value | 1U << number : value & ~(1U << number));
  }
  uint16_t word(const std::string& area, int octet) {
    return static_cast<uint16_t>(areas[area][octet] << 8 | areas[area][octet + 1]);
  }
  void set_word(const std::string& area, int octet, uint16_t value) {
    areas[area][octet] = static_cast<uint8_t>(value >> 8);
    areas[area][octet + 1] = static_cast<uint8_t>(value);
  }

  // Areas: I inputs, Q outputs, M markers; PI and PQ the two directions of the peripherals.
  std::map<std::string, std::map<int, uint8_t>> areas;

 private:
  struct Statement {
    std::string label;
    std::vector<std::string> words;
  };

  static const std::map<std::string, std::string>& operations() {
    static const std::map<std::string, std::string> kAll{
        {"U", "A"},   {"UN", "AN"},   {"SPB", "JC"}, {"BEB", "BEC"}, {"A", "A"},   {"AN", "AN"},
        {"JC", "JC"}, {"BEC", "BEC"}, {"O", "O"},    {"ON", "ON"},   {"O(", "O("}, {")", ")"},
        {"S", "S"},   {"R", "R"},     {"L", "L"},    {"T", "T"},     {"RB", "RB"}, {"BE", "BE"}};
    return kAll;
  }

  // "M 184.6", "=BUSY", "E 4.0"
  struct Place {
    std::string area;
    int octet = 0;
    int number = 0;
  };
  static Place bit_place(const Statement& statement, const std::map<std::string, std::string>& formals) {
    std::vector<std::string> words(statement.words.begin() + 1, statement.words.end());
    if (words.at(0)[0] == '=') {
      std::istringstream actual(formals.at(words[0].substr(1)));
      words.assign(2, "");
      actual >> words[0] >> words[1];
    }
    const size_t dot = words.at(1).find('.');
    return {words[0] == "E"   ? "I"
            : words[0] == "A" ? "Q"
                              : words[0],
            std::stoi(words[1].substr(0, dot)), std::stoi(words[1].substr(dot + 1))};
  }

  void combine(bool value, bool with_or) {
    if (first_)
      rlo_ = value;
    else if (with_or)
      rlo_ = rlo_ || value;
    else
      rlo_ = rlo_ && value;
    first_ = false;
  }
  bool take_condition() {  // of a conditional operation
    first_ = true;
    if (rlo_) return true;
    rlo_ = true;
    return false;
  }

  void transfer(const Statement& s) {
    const std::string& area = s.words.at(1);
    const bool load = s.words[0] == "L";
    if (area == "KH") {
      accu_ = static_cast<uint16_t>(std::stoi(s.words.at(2), nullptr, 16));
    } else if (area == "KF") {
      accu_ = static_cast<uint16_t>(std::stoi(s.words.at(2)));
    } else {
      static const std::map<std::string, std::pair<std::string, std::string>> kWords{
          {"MW", {"M", "M"}},   {"PW", {"PI", "PQ"}}, {"IW", {"PI", "PI"}}, {"EW", {"PI", "PI"}},
          {"OW", {"PQ", "PQ"}}, {"AW", {"PQ", "PQ"}}, {"QW", {"PQ", "PQ"}}};
      const auto& [from, to] = kWords.at(area);
      const int octet = std::stoi(s.words.at(2));
      if (load)
        accu_ = word(from, octet);
      else
        set_word(to, octet, accu_);
    }
  }

  void execute(const std::string& block, const std::map<std::string, std::string>& formals) {
    const std::vector<Statement>& program = blocks_.at(block);
    first_ = true;
    for (size_t at = 0; at < program.size(); ++at) {
      const Statement& s = program[at];
      const std::string& operation = s.words[0];
      if (operation == "L" || operation == "T") {
        transfer(s);
      } else if (operation == "O(") {
        outer_ = rlo_;
        first_ = true;
      } else if (operation == ")") {
        rlo_ = rlo_ || outer_;
      } else if (operation == "BE") {
        return;
      } else if (operation == "BEC") {
        if (take_condition()) return;
      } else if (operation == "JC") {
        if (!take_condition()) continue;
        if (s.words.at(1) == "FB") {
          call(s);
          continue;
        }
        const std::string label = s.words[1].substr(1);
        at = 0;
        while (program.at(at).label != label) ++at;
        --at;
      } else {
        const Place place = bit_place(s, formals);
        if (operation == "S" || operation == "R" || operation == "RB") {
          if (rlo_) set_bit(place.area, place.octet, place.number, operation == "S");
          first_ = true;
        } else {
          const bool value = bit(place.area, place.octet, place.number);
          combine(operation.back() == 'N' ? !value : value, operation[0] == 'O');
        }
      }
    }
  }

  // "SPB FB 101 READ=M_1.0 BUSY=M_1.1"
  void call(const Statement& s) {
    std::map<std::string, std::string> actual;
    for (size_t n = 3; n < s.words.size(); ++n) {
      std::string pair = s.words[n];
      const size_t equal = pair.find('=');
      pair[pair.find('_')] = ' ';
      actual[pair.substr(0, equal)] = pair.substr(equal + 1);
    }
    execute("FB " + s.words.at(2), actual);
  }

  std::map<std::string, std::vector<Statement>> blocks_;
  bool rlo_ = false;
  bool outer_ = false;  // before O(
  bool first_ = true;   // the next bit begins a new result
  uint16_t accu_ = 0;
};

}  // namespace ipos::tests
