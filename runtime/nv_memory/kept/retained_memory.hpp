// What _Memorize orders from the non-volatile memory of a unit. Of the variables H0..H127 are kept
// (IPOSplus p. 320).
#pragma once

#include <cstdint>

namespace ipos::runtime {

// Argument of _Memorize; the values of the keyword set `mem`.
enum class Memorize : int32_t { Nothing = 0, StoreAll = 1, LoadAll = 2, StoreProgram = 3, StoreData = 4 };

class RetainedMemory {
 public:
  // False: the memory does not work (F25). LoadAll brings back the data; the program is the one that runs
  // (ours).
  virtual bool memorize(Memorize what) = 0;

 protected:
  ~RetainedMemory() = default;
};

}  // namespace ipos::runtime
