#include "core/perceived/perceived.h"

#include <cassert>
#include <cmath>
#include <limits>

#include "core/perceived/surfaces.h"
#include "core/perceived/view_engine.h"

namespace ilf {

std::string_view word(Rung rung) {
    switch (rung) {
    case Rung::dragging:
        return "while dragging";
    case Rung::rest:
        return "at rest";
    case Rung::idle:
        return "refined";
    }
    return "";
}

Result<Radiance> perceived(const Document& document, const Plan& plan, const Program& program,
                           const ViewRequest& request) {
    const auto view = ViewEngine().see(document, plan, program, request);
    if (!view) return tl::unexpected(view.error());
    return view->radiance();
}

Radiance plainView(const Document& document, double scale) {
    return document.scene.picture ? view::albedo(document, view::viewScale(document, scale)) : Radiance();
}

double psnr(const Radiance& a, const Radiance& b) {
    assert(a.size() == b.size() && a.channels() == b.channels());
    double sum = 0.0;
    for (std::size_t i = 0; i < a.pixels().size(); ++i) {
        const double difference = static_cast<double>(a.pixels()[i]) - static_cast<double>(b.pixels()[i]);
        sum += difference * difference;
    }
    if (sum == 0.0) return std::numeric_limits<double>::infinity();
    return -10.0 * std::log10(sum / static_cast<double>(a.pixels().size()));
}

}  // namespace ilf
