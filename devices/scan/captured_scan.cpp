#include "devices/scan/captured_scan.h"

#include <utility>

namespace ilf::devices {
namespace {

/// Whatever happens, light ends safe.
struct SafeAtTheEnd {
    PatternShow& show;
    ~SafeAtTheEnd() { show.safe(); }
};

std::string wordsOf(const Pattern& pattern, int bits) {
    const bool columns = pattern.kind == Pattern::Kind::column;
    return std::string("Stripes ") + (columns ? "down" : "across") + ", " + std::to_string(pattern.bit + 1) + " of " +
           std::to_string(bits);
}

int bitsOf(const std::vector<Pattern>& patterns, Pattern::Kind kind) {
    int bits = 0;
    for (const Pattern& pattern : patterns)
        bits += pattern.kind == kind && !pattern.inverse ? 1 : 0;
    return bits;
}

}  // namespace

Result<CapturedScan> capturedScan(CameraSource& camera, PatternShow& show, const ScanWish& wish, const ScanWatch& watch,
                                  const std::stop_token& stop, const AfterScan& then) {
    PatternCamera taker(camera, show, wish, watch, stop);
    return capturedScan(taker, camera, show, then);
}

Result<CapturedScan> capturedScan(PatternCamera& taker, CameraSource& camera, PatternShow& show,
                                  const AfterScan& then) {
    const SafeAtTheEnd safe{show};
    if (const auto begun = taker.begin(); !begun) return tl::unexpected(begun.error());
    Scan scan;
    scan.projector = show.projector();
    scan.patterns = grayCodePatterns(scan.projector);
    const int all = static_cast<int>(scan.patterns.size());
    for (std::size_t i = 0; i < scan.patterns.size(); ++i) {
        const Pattern& pattern = scan.patterns[i];
        if (pattern.kind == Pattern::Kind::white || pattern.kind == Pattern::Kind::black) {
            scan.pictures.push_back(pattern.kind == Pattern::Kind::white ? taker.white() : taker.black());
            continue;
        }
        taker.tell(ScanProgress::Step::patterns, static_cast<int>(i), all,
                   wordsOf(pattern, bitsOf(scan.patterns, pattern.kind)));
        auto pair = taker.pair(pattern);
        if (!pair) return tl::unexpected(pair.error());
        scan.pictures.push_back(std::move(pair->picture));
        scan.pictures.push_back(std::move(pair->inverse));
        ++i;  // its inverse follows it in the list
    }
    taker.tell(ScanProgress::Step::closing, all, all, "Making sure that nothing moved");
    if (const auto still = taker.unmoved(); !still) return tl::unexpected(still.error());
    CapturedScan captured = taker.facts();
    captured.scan = std::move(scan);
    captured.mode = camera.mode();
    if (captured.mode.picture == Size{}) captured.mode.picture = taker.white().size();
    if (then) {
        if (const auto done = then(taker, captured); !done) return tl::unexpected(done.error());
    }
    return captured;
}

}  // namespace ilf::devices
