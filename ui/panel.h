// What every panel gets: what it may read, what it may change, and where its requests go.
#pragma once

#include <utility>

#include "ui/layout.h"
#include "ui/studio.h"

namespace ilf::ui {

struct Panel {
    const View& view;
    State& state;
    const Input& input;
    Requests& requests;
    Layout at;
    double scale = 1.0;

    float px(double unscaled) const { return static_cast<float>(unscaled * scale); }
    const Document& document() const { return view.document; }
    const Plan* plan() const { return view.computed.plan ? &*view.computed.plan : nullptr; }
    /// What the plan says of a region; nullptr when it takes no part.
    const RegionPlan* planOf(const RegionId& id) const;
    /// The selected region or the background; nullptr when nothing is selected.
    const Region* selected() const { return findRegion(view.document, state.selected); }

    void preview(Edit edit) { requests.push_back(EditRequest{EditRequest::When::preview, std::move(edit)}); }
    void commit(Edit edit) { requests.push_back(EditRequest{EditRequest::When::commit, std::move(edit)}); }
    void edit(bool commits, Edit edit) { commits ? commit(std::move(edit)) : preview(std::move(edit)); }
    void run(Command command);
};

void topBar(Panel& p);
void toolBar(Panel& p);
void canvasHeader(Panel& p);
void canvas(Panel& p);
void regionsPanel(Panel& p);
void selectedPanel(Panel& p);
void pagesPanel(Panel& p);
void wearerPage(Panel& p);
void seamPage(Panel& p);
void lightPage(Panel& p);
void rigPage(Panel& p);
void scenePage(Panel& p);
void historyPage(Panel& p);
void selectedPage(Panel& p);
void chartsRow(Panel& p);
void statusLine(Panel& p);
void debugPanel(Panel& p);
void primariesRows(Panel& p);
void splitters(Panel& p);
void toasts(Panel& p);
void hints(Panel& p);
void dialogs(Panel& p);
void openFileDialog(State& state, FileDialog::Purpose purpose, const View& view);
/// Keys that were pressed become commands; held keys their states.
void shortcutKeys(Panel& p);

}  // namespace ilf::ui
