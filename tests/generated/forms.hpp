// Random statements of the forms that take fewer commands than what stands in the source: switch, bits, copies, indexes, loops.
#pragma once

#include <fmt/format.h>

#include <initializer_list>
#include <set>
#include <string>

#include "tests/generated/pcg.hpp"

namespace ipos::tests {

// Random statements on the variables of one root, which have its letter in front.
class Forms {
 public:
  // `wild`: places beyond their arrays, too, among them the variables that a loop counts with.
  Forms(Pcg& random, std::string letter, bool wild = false) : random_(random), letter_(std::move(letter)), wild_(wild) {}

  std::string declarations() const {
    const std::string& l = letter_;
    return fmt::format("long {0}x, {0}y, {0}o, {0}i, {0}a[8], {0}j, {0}b[8], {0}k;\n{0}T {0}t[4];\n", l);
  }
  std::string type() const { return fmt::format("typedef struct {{ long p; long q; long r; }} {}T;\n", letter_); }

  std::string statements(int count) {
    std::string text;
    for (int n = 0; n < count; ++n) text += statement();
    return text;
  }

 private:
  std::string name(const char* variable) const { return letter_ + variable; }
  std::string one_of(std::initializer_list<std::string> texts) {
    return *(texts.begin() + random_.below(static_cast<int>(texts.size())));
  }
  std::string simple() { return one_of({name("x"), name("y"), name("o")}); }
  std::string number() {
    if (random_.one_in(8)) return one_of({"2147483647", "-2147483648", "-1", "65535"});
    return std::to_string(random_.between(-9, 20));
  }
  std::string index() { return fmt::format("{} & 3", simple()); }
  std::string mask() { return std::to_string(1 << random_.below(5)); }
  std::string bit_number() { return std::to_string(random_.below(5)); }

  std::string tested_bit() {
    const std::string x = simple(), m = mask();
    return one_of({x + " & " + m, "!(" + x + " & " + m + ")", "(" + x + " & " + m + ") != 0", "(" + x + " & " + m + ") == 0",
                   "(" + x + " & " + m + ") == " + m, "(" + x + " & " + m + ") == " + mask(), x + " >> " + bit_number() + " & 1", x});
  }
  std::string bits() {
    const std::string o = simple(), m = mask(), test = tested_bit();
    const std::string set = one_of({o + " |= " + m + ";", "{ " + o + " = " + o + " | " + m + "; }"});
    const std::string clear = one_of({o + " &= ~" + m + ";", "{ " + o + " = " + o + " & ~" + m + "; }"});
    const std::string k = bit_number();
    switch (random_.below(5)) {
      case 0: return "if (" + test + ") " + set + " else " + clear + "\n";
      case 1: return "if (" + test + ") " + clear + " else " + set + "\n";
      case 2: return "if (" + test + ") _BitSet(" + o + ", " + k + "); else _BitClear(" + o + ", " + k + ");\n";
      case 3: return o + " = " + test + " ? " + o + " | " + m + " : " + o + " & ~" + m + ";\n";
      default: return "if (" + test + ") " + set + " else " + o + " &= ~" + mask() + ";\n";
    }
  }
  std::string copy() {
    const std::string i = name("i"), to = one_of({name("a"), name("b")}), from = one_of({name("a"), name("b")});
    const int first = random_.below(4), last = random_.between(first, 8);
    return fmt::format("for ({0} = {1}; {0} {2} {3}; {4}) {5}[{0}] = {6}[{0}];\n{7} += {0};\n", i, first, one_of({"<", "!=", "<"}), last,
                       one_of({i + "++", "++" + i, i + " += 1"}), to, from, simple());
  }
  std::string element() {
    const std::string i = name("i");
    return one_of({name("a") + "[" + i + "]", name("b") + "[" + i + "]", name("t") + "[" + i + "].p", name("t") + "[" + i + "].q",
                   name("t") + "[" + i + "].r", name("a") + "[" + i + " + 1]"});
  }
  std::string indexes() {
    const std::string target = random_.one_in(4) ? simple() : element();
    const std::string value = element() + one_of({" + ", " - ", " * ", " ^ "}) + one_of({element(), number(), simple()}) +
                              one_of({"", " + " + element(), " * 3"});
    return name("i") + " = " + index() + ";\n" + target + one_of({" = ", " = ", " += ", " -= ", " ^= "}) + value + ";\n";
  }
  std::string choice() {
    std::string text = "switch (" + one_of({simple(), simple() + " & 15", simple() + " % 7"}) + ")\n{\n";
    std::set<std::string> used;
    const int cases = random_.below(12);
    const int otherwise = random_.between(-1, cases);
    for (int n = 0; n <= cases; ++n) {
      if (n == otherwise) text += "default: " + simple() + " += 1000;\n";
      const std::string label = number();
      if (n == cases || !used.insert(label).second) continue;
      text += "case " + label + ": " + simple() + " += " + number() + ";\n" + (random_.one_in(4) ? "" : "break;\n");
    }
    return text + "}\n";
  }
  std::string fill() {
    const std::string i = name("i");
    const int first = random_.below(4), last = random_.between(first, 8);
    const bool up = !random_.one_in(3);
    return fmt::format("for ({0} = {1}; {0} {2} {3}; {0}{4}) {5}[{0}] = {6};\n", i, up ? first : last - 1, up ? "<" : ">=", up ? last : first,
                       up ? "++" : "--", one_of({name("a"), name("b")}), one_of({number(), simple(), name("a") + "[" + i + "]", i}));
  }
  std::string shift() {
    const std::string i = name("i"), to = one_of({name("a"), name("b")}), from = one_of({name("a"), name("b")});
    const int by = random_.between(-3, 3), first = 3 + random_.below(2), last = random_.between(2, 4);
    return random_.one_in(2) ? fmt::format("for ({0} = {1}; {0} > {2}; {0}--) {3}[{0}] = {4}[{0} + {5}];\n", i, first, last - 2, to, from, by)
                             : fmt::format("for ({0} = {1}; {0} <= {2}; {0}++) {3}[{0}] = {4}[{0} - {5}];\n", i, last, first, to, from, by);
  }

  // A number from 0 to 3 in a body where i and j are from 1 to 3; or, if it is wild, anything near.
  std::string place() {
    const std::string i = name("i"), j = name("j");
    if (wild_) return one_of({i, j, i + " + 1", i + " - 1", i + " * 3 + " + j, "7 - " + i, i + " * 2 - " + j, "(" + i + " << 1) + 1", simple() + " & 7"});
    return one_of({i, i, j, i + " - 1", "4 - " + i, i + " * 2 - " + i, i + " - " + j + " & 3", "3 - " + j, "(" + j + " << 1) - " + j});
  }
  std::string placed() {
    const std::string array = one_of({name("a"), name("b")});
    return one_of({array + "[" + place() + "]", array + "[" + place() + "]", array + "[" + place() + " + 4]",
                   name("t") + "[" + place() + one_of({"].p", "].q", "].r"})});
  }
  std::string turn(int depth) {
    const std::string i = name("i"), j = name("j");
    switch (random_.below(depth > 0 ? 12 : 11)) {
      case 0:
      case 1: return placed() + one_of({" = ", " += ", " ^= "}) + one_of({placed(), placed() + " * 3", number(), simple()}) + ";\n";
      case 2: return placed() + one_of({"++;\n", "--;\n"});
      case 3: return simple() + one_of({" = ", " += ", " ^= "}) + placed() + one_of({";\n", " - " + placed() + ";\n"});
      case 4: return "if (" + placed() + one_of({" > ", " == "}) + one_of({placed(), simple()}) + ") " + simple() + " = " + placed() + ";\n";
      case 5: return "if (" + simple() + " & " + mask() + ") " + one_of({placed() + " = " + number() + ";\n", "break;\n", "continue;\n"});
      case 6: return "if (" + i + " * 10 + " + j + one_of({" > ", " < "}) + simple() + ") " + simple() + " += " + i + " * 5;\n";
      case 7: return placed() + " = " + i + " * 6 + " + j + " * 2 + 1;\n";
      case 8: return simple() + " = " + placed() + " + (" + i + " * 4 - 3);\n";
      case 9: return wild_ ? one_of({i + "++;\n", i + " = " + i + " + 2;\n", j + " -= 1;\n", i + " = " + simple() + " & 7;\n", simple() + "++, " + i + "--;\n"})
                           : simple() + " += " + placed() + ";\n";
      case 10: return "switch (" + one_of({i, placed()}) + ") { case 1: " + placed() + " = " + i + "; break; case 2: " + simple() + " += " + placed() + "; default: " +
                      one_of({"continue;", simple() + "++;"}) + " }\n";
      default: return loop(j, depth - 1) + (wild_ ? "" : j + " = 1;\n");
    }
  }
  // Ends by k at the latest.
  std::string loop(const std::string& i, int depth) {
    const std::string k = name("k");
    std::string body = "if (++" + k + " > " + std::to_string(wild_ ? 14 : 40) + ") break;\n";
    for (int n = random_.between(1, 4); n > 0; --n) body += turn(depth);
    const std::string more = random_.one_in(4) ? " && " + placed() + " != " + number() : "";
    const int first = wild_ ? random_.between(-2, 4) : 1;
    const std::string limit = wild_ ? one_of({std::to_string(random_.between(-1, 8)), simple() + " % 8", name("j")}) : std::to_string(random_.between(1, 4));
    switch (random_.below(5)) {
      case 0:
      case 1:
        return fmt::format("for ({0} = {1}; {0} < {2}{3}; {4})\n{{\n{5}}}\n", i, first, limit, more,
                           one_of({i + "++", "++" + i, i + " += " + (wild_ ? "2" : "1"), i + " = " + i + " + 1", i + "++, " + simple() + "--"}), body);
      case 2:
        return fmt::format("for ({0} = {1}; {0} {2}{3}; {4})\n{{\n{5}}}\n", i, wild_ ? 6 : 3, wild_ ? "> " + limit : one_of({"> 0", ">= 1", "!= 0"}), more,
                           one_of({i + "--", i + " -= 1", i + " += -1"}), body);
      case 3: return fmt::format("{0} = {1};\nwhile ({0} < {2}{3})\n{{\n{4}{0}++;\n}}\n", i, first, limit, more, body);
      default: return fmt::format("{0} = {1};\ndo\n{{\n{4}{0}++;\n}}\nwhile ({0} < {2}{3});\n", i, first, limit, more, body);
    }
  }
  std::string loops() { return fmt::format("{0}j = {1};\n{0}k = 0;\n", letter_, random_.between(1, 3)) + loop(name("i"), 2); }

  std::string statement() {
    switch (random_.below(10)) {
      case 6: return fill();
      case 7: return shift();
      case 8:
      case 9: return loops();
      case 0: return bits();
      case 1: return copy();
      case 2: return indexes();
      case 3: return choice();
      case 4: return name("a") + "[" + index() + "] = " + simple() + ";\n";
      default: return simple() + one_of({" = ", " += ", " ^= "}) + number() + ";\n";
    }
  }

  Pcg& random_;
  std::string letter_;
  bool wild_;
};

// A program of them alone.
inline std::string forms_program(uint64_t seed) {
  Pcg random(seed);
  Forms forms(random, "m", random.one_in(2));
  return "#include <constb.h>\n#pragma var H900 H999\n#pragma globals 200 399\n" + forms.type() + forms.declarations() + "main()\n{\n" +
         forms.statements(random.between(5, 30)) + "}\n";
}

}  // namespace ipos::tests
