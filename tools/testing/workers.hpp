// Work on several threads: each takes the next piece.
#pragma once

#include <cstddef>
#include <functional>

namespace ipos::tools::testing {

// Calls work(n) for each n below `count`, on as many threads as `jobs` says. After an exception nothing is begun any more, and
// the first one is passed on when all threads are done.
void share_work(size_t count, unsigned jobs, const std::function<void(size_t n)>& work);

}  // namespace ipos::tools::testing
