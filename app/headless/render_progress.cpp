#include "app/headless/render_progress.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

namespace ilf::app {

void RenderProgress::show(double done, const std::string& doing) {
    if (width_ == 0) return;
    constexpr int kBar = 24;
    const double share = std::clamp(done, 0.0, 1.0);
    const auto full = static_cast<std::size_t>(std::lround(share * kBar));
    std::string line = "[" + std::string(full, '#') + std::string(kBar - full, '.') + "] " +
                       std::to_string(std::lround(100.0 * share)) + " %  " + doing;
    // One column less than there is: a full line would wrap, and could not be drawn over. Bytes are at least columns.
    line.resize(std::min(line.size(), static_cast<std::size_t>(std::max(1, width_ - 1))));
    out_ << "\r\x1b[K" << line << std::flush;
    shown_ = true;
}

void RenderProgress::cleared() {
    if (!shown_) return;
    out_ << "\r\x1b[K" << std::flush;
    shown_ = false;
}

int terminalWidth() {
    if (::isatty(STDERR_FILENO) == 0) return 0;
    winsize size{};
    constexpr int kUsual = 80;
    return ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : kUsual;
}

}  // namespace ilf::app
