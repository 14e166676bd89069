// What the wearer is predicted to see of the selected region: one sentence with its +-, and beneath what it rests on.
#pragma once

#include "core/perceived/prediction_words.h"
#include "ui/panel.h"

namespace ilf::ui {

/// A prediction and all that it was made from, kept so that a frame in which nothing changed works nothing out.
struct PredictedRegion {
    Plan plan;
    Region region;
    Seam seam;
    Wearer wearer;
    PixelScale scale;
    RegionPrediction seen;
    Statement said;
};

/// `p.state.predicted`, brought up to date for a region.
const PredictedRegion& predictedRegion(Panel& p, const Region& region, const RegionPlan& planned);

/// While it lives, rows lie closer: for figures that are read, not typed.
class CompactRows {
public:
    explicit CompactRows(const Panel& p);
    ~CompactRows();
    CompactRows(const CompactRows&) = delete;
    CompactRows& operator=(const CompactRows&) = delete;
};

/// The card, and under it the other figures.
void predictionCard(Panel& p, const Region& region, const RegionPlan& planned);

}  // namespace ilf::ui
