// Who else sees the values of a variable while a function writes it: other tasks and interrupt routines, also
// by their pointers; telegrams, watched variables and cams; a bus that reads Hn as parameter 11000 + n. What
// main does before it starts anything is seen by nobody but the last.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

#include "compiler/sema/call_graph.hpp"
#include "compiler/sema/context.hpp"

namespace ipos::compiler {

struct Observer {
  std::string who;           // "'Reader' uses it"
  Span span;                 // where that can be read
  std::string note;          // what is to be read there
  bool by_number = false;    // only that it is an Hn, which a bus may ask for
  bool writes_only = false;  // does not read it
};

class Observers {
 public:
  // Last of the checks: the record of accesses moves here.
  explicit Observers(Context& context);

  // Who sees a variable that `function` writes, if anybody. `early`: before anything is started.
  std::optional<Observer> find(size_t function, uint32_t variable, bool early) const;

  // Whether anything but `function` may write the variable, or the function itself while it runs for another root.
  bool may_change(size_t function, uint32_t variable, bool early) const;

  // Whether a statement of main comes before anything is started, or everything that calls a function does.
  bool is_early(const checked::Stmt& stmt) const { return early_.contains(&stmt); }
  bool is_early(size_t function) const { return !late_[function]; }

 private:
  std::optional<Observer> other_root(size_t function, uint32_t variable) const;
  bool run_at_once(size_t one, size_t other) const;

  std::unordered_map<uint32_t, Access> accesses_;
  std::map<uint32_t, Span> raw_names_;
  std::vector<AccessPlace> indirect_;
  std::vector<std::string> names_;        // of the functions
  std::vector<uint64_t> roots_;           // what runs a function, a bit each
  std::set<const checked::Stmt*> early_;  // statements
  std::vector<bool> late_;                // functions
  std::set<uint32_t> handed_over_;        // members that hold numbers for the unit, not for pointers
  std::unordered_map<uint32_t, Observer> watched_;  // variables the unit looks at by itself
  std::optional<Observer> anywhere_;                // it does, and which ones is known at run time only
};

}  // namespace ipos::compiler
