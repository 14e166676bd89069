#include "app/scan/light_check.h"

#include "devices/scan/core_show.h"

namespace ilf::app {

Result<LightCheck> lightChecked(ScanOrder order, const devices::ScanWatch& watch, const std::stop_token& stop) {
    const auto camera = openedCamera(order);
    if (!camera) return tl::unexpected(camera.error());
    order.wish.anyway = true;  // the figures are wanted whatever they say
    devices::CoreShow show(order.runtimeDirectory, order.rig, order.rest, stop);
    devices::PatternCamera taker(**camera, show, order.wish, watch, stop);
    const auto begun = taker.begin();
    show.safe();
    if (!begun && stop.stop_requested()) return tl::unexpected(begun.error());
    const devices::CapturedScan& facts = taker.facts();
    LightCheck check{facts.ambient, facts.exposure, facts.remarks, {}};
    if (!begun) check.trouble = begun.error().what;
    return check;
}

}  // namespace ilf::app
