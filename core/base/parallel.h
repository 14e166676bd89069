// A loop over independent indices, shared between two threads.
#pragma once

#include <functional>

namespace ilf {

/// Calls `work(i)` once for every 0 <= i < count and returns when all are done. The calls may run on the caller and on
/// one helper thread at a time, in any order; they must not touch each other's results. So the outcome cannot depend on
/// the number of threads. Nested or concurrent calls run on their caller alone. What
/// `work` throws ends the loop and reaches the caller.
void parallelFor(int count, const std::function<void(int)>& work);

}  // namespace ilf
