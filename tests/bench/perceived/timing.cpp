#include "tests/bench/perceived/timing.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

namespace ilf::bench {
namespace {

using Clock = std::chrono::steady_clock;

double seconds(timeval t) { return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec); }

}  // namespace

Load Load::now() {
    Load load;
    load.at = Clock::now();
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    load.own = seconds(usage.ru_utime) + seconds(usage.ru_stime);
    // cpu user nice system idle iowait irq softirq steal ...: all but idle and iowait, in ticks.
    std::ifstream stat("/proc/stat");
    std::string cpu;
    stat >> cpu;
    double ticks = 0.0, value = 0.0;
    for (int field = 0; field < 8 && stat >> value; ++field)
        if (field != 3 && field != 4) ticks += value;
    load.all = ticks / static_cast<double>(sysconf(_SC_CLK_TCK));
    return load;
}

double loadAverage() {
    double average = 0.0;
    return getloadavg(&average, 1) == 1 ? average : 0.0;
}

Times timed(const Patience& patience, const std::function<void(int)>& work, const std::function<void(int)>& prepare) {
    std::vector<double> milliseconds;
    Load before;
    const auto start = Clock::now();
    double spent = 0.0;
    for (int i = 0; static_cast<int>(milliseconds.size()) < patience.most; ++i) {
        if (prepare) prepare(i);
        if (i == 1) before = Load::now();
        const auto from = Clock::now();
        work(i);
        const double ms = std::chrono::duration<double, std::milli>(Clock::now() - from).count();
        if (i > 0) milliseconds.push_back(ms);
        spent = std::chrono::duration<double>(Clock::now() - start).count();
        const int done = static_cast<int>(milliseconds.size());
        if (done >= patience.least && spent > patience.seconds) break;
        if (done >= patience.enough && spent > 0.3 * patience.seconds) break;
    }
    const Load after = Load::now();
    Times times;
    times.repetitions = static_cast<int>(milliseconds.size());
    const double elapsed = std::chrono::duration<double>(after.at - before.at).count();
    times.own = (after.own - before.own) / elapsed;
    times.others = std::max(0.0, (after.all - before.all) / elapsed - times.own);
    std::ranges::sort(milliseconds);
    const auto at = [&](double share) {
        return milliseconds[static_cast<std::size_t>(share * static_cast<double>(milliseconds.size() - 1) + 0.5)];
    };
    times.p50 = at(0.5);
    times.p95 = at(0.95);
    times.least = milliseconds.front();
    return times;
}

}  // namespace ilf::bench
