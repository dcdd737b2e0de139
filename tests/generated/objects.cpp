// Numbers after LANGUAGE rules: `long` from H420 or the start of #pragma globals, `initial long` from H0 or
// the start of #pragma initials, in order of declaration.
#include "tests/generated/objects.hpp"

#include <algorithm>

namespace ipos::tests {
namespace {

struct StructType {
  std::string name;
  std::vector<std::string> members;
};

class Declarations {
 public:
  Declarations(Pcg& random, Program& program) : random_(random), program_(program) {}

  Objects run() {
    pragmas();
    types();
    constants();
    const int32_t counters = wide_ ? 30 : 9;
    const int32_t data_end = last_global_ - counters - 3;
    while (next_global_ < data_end) data(data_end);
    initials();
    raw();
    const int pointers = random_.between(1, 3);
    for (int i = 0; i < pointers; ++i)
      objects_.pointers.push_back(single("long ", name("p", i), next_global_));
    for (int i = 0; i < counters; ++i)
      objects_.counters.push_back(single("long ", name("c", i), next_global_));
    aliases();
    for (int i = 0; i < 5; ++i) objects_.hot.push_back(random_.pick(objects_.scalars));
    return std::move(objects_);
  }

 private:
  void head(const std::string& text) { program_.head.push_back(text); }

  std::string name(const char* stem, int index) {
    static constexpr const char* kPrefixes[] = {"", "l", "Drive_", "_x_"};
    return kPrefixes[random_.below(4)] + std::string(stem) + std::to_string(index);
  }

  void range(const std::string& kind, int32_t low, int32_t high) {
    std::string text = "#pragma " + kind;
    for (const int32_t bound : {low, high}) text += (random_.one_in(2) ? " H" : " ") + std::to_string(bound);
    head(text);
  }

  void pragmas() {
    if (random_.one_in(3)) head("#include <const.h>");
    if (random_.one_in(2)) {
      wide_ = true;
      next_global_ = random_.between(150, 180);
      last_global_ = next_global_ + random_.between(60, 100);
      range("globals", next_global_, last_global_);
    }
    if (random_.one_in(3)) {
      program_.first_temporary = random_.between(300, 340);
      program_.last_temporary = program_.first_temporary + random_.between(40, 59);
      range("var", program_.first_temporary, program_.last_temporary);
    }
    if (random_.one_in(4)) {
      next_initial_ = random_.between(1, 40);
      range("initials", next_initial_, next_initial_ + 30);
    }
    if (random_.one_in(8)) head("#pragma list");
  }

  void types() {
    const int count = random_.between(1, 2);
    for (int t = 0; t < count; ++t) {
      StructType type{"TYPE" + std::to_string(t), {}};
      std::string text = "typedef struct { ";
      const int members = random_.between(2, 4);
      for (int m = 0; m < members; ++m) {
        type.members.push_back(name("m", m));
        text += "long " + type.members.back() + "; ";
      }
      head(text + "} " + type.name + ";");
      types_.push_back(type);
    }
    // 1053 1610 p. 54; known without any #include.
    types_.push_back({"SCTRCYCL", {"ObjectNo", "CycleTime", "Offset", "Format", "DPointer", "Result"}});
  }

  void constants() {
    for (int i = 0; i < 2; ++i) {
      Expr macro;
      macro.kind = ExprKind::Macro;
      macro.text = "K" + std::to_string(i);
      macro.parts = {number_of(random_.between(-40, 40))};
      macro.parts[0].parentheses = true;
      objects_.macros.push_back(macro);
    }
    for (const Expr& macro : objects_.macros)
      head("#define " + macro.text + " (" +
           (macro.parts[0].kind == ExprKind::Unary ? "-" + macro.parts[0].parts[0].text
                                                   : macro.parts[0].text) +
           ")");
  }

  Named single(const std::string& type, const std::string& text, int32_t& next) {
    head(type + text + ";");
    return {text, next++};
  }

  void data(int32_t end) {
    const int32_t room = end - next_global_;
    const int kind = random_.below(6);
    if (kind == 0 && room >= 6) {
      const int type = random_.below(static_cast<int>(types_.size()));
      structure(type);
      if (random_.one_in(2) && end - next_global_ >= 6) structure(type);
    } else if (kind == 1 && room >= 2) {
      static constexpr int32_t kSizes[] = {1, 2, 3, 4, 5, 8, 10};
      int32_t size = kSizes[random_.below(7)];
      if (size > room) size = 2;
      array("long ", size, next_global_);
    } else {
      std::string text = "long ";
      const int count = std::min(random_.between(1, 3), room);
      for (int i = 0; i < count; ++i) {
        const std::string variable = name("g", unique_++);
        text += (i == 0 ? "" : random_.one_in(4) ? ",\n  " : ", ") + variable;
        objects_.scalars.push_back({variable, next_global_++});
      }
      head(text + ";");
    }
  }

  void structure(int type) {
    const StructType& row = types_[static_cast<size_t>(type)];
    const std::string variable = name("s", unique_++);
    head(row.name + " " + variable + ";");
    const auto size = static_cast<int32_t>(row.members.size());
    objects_.structures.push_back({variable, next_global_, size, type});
    for (const std::string& member : row.members)
      objects_.scalars.push_back({variable + "." + member, next_global_++});
  }

  void array(const std::string& type, int32_t size, int32_t& next) {
    const std::string variable = name("a", unique_++);
    head(type + variable + "[" + std::to_string(size) + "];");
    objects_.arrays.push_back({variable, next, size, -1});
    objects_.scalars.push_back({variable + "[" + std::to_string(size - 1) + "]", next + size - 1});
    next += size;
  }

  void initials() {
    const int count = random_.below(4);
    for (int i = 0; i < count; ++i) {
      const std::string type = random_.one_in(2) ? "initial long " : "initial  long\t";
      if (random_.one_in(3))
        array(type, random_.between(2, 4), next_initial_);
      else
        objects_.scalars.push_back(single(type, name("i", unique_++), next_initial_));
    }
  }

  // H0 is free in every program: an initial variable, or raw.
  void raw() {
    const int count = random_.between(1, 4);
    for (int i = 0; i < count; ++i) {
      const int32_t number = random_.between(128, 139);
      objects_.scalars.push_back({(random_.one_in(3) ? "H0" : "H") + std::to_string(number), number});
    }
    // Variables the unit acts on are computed elsewhere first; without a unit they are plain ones.
    if (random_.one_in(3)) objects_.scalars.push_back({"H481", 481});
    if (random_.one_in(3)) objects_.scalars.push_back({"H492", 492});
    objects_.scalars.push_back({"H0", 0});
  }

  void aliases() {
    if (random_.one_in(2)) {
      const int32_t base = random_.between(128, 134), offset = random_.between(0, 5);
      head("#declare Alias0 H" + std::to_string(base) + " + " + std::to_string(offset));
      objects_.scalars.push_back({"Alias0", base + offset});
    }
    if (random_.one_in(2)) {
      const Named& of = random_.pick(objects_.scalars);
      if (of.text.find_first_of(".[") == std::string::npos) {
        head("#declare Alias1 " + of.text);
        objects_.scalars.push_back({"Alias1", of.number});
      }
    }
    if (!objects_.structures.empty() && random_.one_in(2)) {
      const Aggregate& of = random_.pick(objects_.structures);
      head("#declare Alias2 " + of.name + " + 1");
      objects_.scalars.push_back({"Alias2", of.number + 1});
    }
  }

  Pcg& random_;
  Program& program_;
  Objects objects_;
  std::vector<StructType> types_;
  bool wide_ = false;
  int unique_ = 0;
  int32_t next_global_ = 420, last_global_ = 452;
  int32_t next_initial_ = 0;
};

}  // namespace

Expr number_of(int32_t value) {
  Expr out;
  out.kind = ExprKind::Number;
  out.value = value;
  if (value >= 0) {
    out.text = std::to_string(value);
    return out;
  }
  out.value = static_cast<int32_t>(-static_cast<int64_t>(value));
  out.text = std::to_string(out.value);
  Expr minus;
  minus.kind = ExprKind::Unary;
  minus.op = Op::Minus;
  minus.parts = {out};
  return minus;
}

Expr variable_of(const Named& name) {
  Expr out;
  out.kind = ExprKind::Variable;
  out.value = name.number;
  out.text = name.text;
  return out;
}

Objects declare(Pcg& random, Program& program) { return Declarations(random, program).run(); }

}  // namespace ipos::tests
