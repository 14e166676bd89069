#include "app/headless/prepare.h"

#include <chrono>
#include <iostream>

#include "app/exit_code.h"

namespace ilf::app {
namespace {

class Stopwatch {
public:
    /// Milliseconds since the last lap.
    double lap() {
        const auto now = std::chrono::steady_clock::now();
        const double ms = std::chrono::duration<double, std::milli>(now - last_).count();
        last_ = now;
        return ms;
    }

private:
    std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace

Result<Prepared> prepared(const std::string& file, const RigChoice& rig) {
    Prepared result;
    Stopwatch watch;
    auto opened = openAny(file);
    if (!opened) return tl::unexpected(opened.error());
    result.opened = *std::move(opened);
    result.open_ms = watch.lap();
    const auto planned = plannedFor(result.opened.document, rig);
    if (!planned) return tl::unexpected(planned.error());
    result.plan_ms = watch.lap();
    auto compiled = compile(result.opened.document, *planned);
    if (!compiled) return tl::unexpected(compiled.error());
    result.compiled = *std::move(compiled);
    result.compile_ms = watch.lap();
    return result;
}

int refused(const char* command, const Error& error) {
    std::cerr << "illuminatedfocus " << command << ": " << error.what << '\n';
    return exitCode(error);
}

}  // namespace ilf::app
