// Where everything is, at every window size and scale.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "tests/support/law.h"
#include "ui/layout.h"
#include "ui/state.h"
#include "ui/viewport.h"

using namespace ilf;
using namespace ilf::ui;

namespace {

std::vector<Rect> panelsOf(const Layout& at) {
    std::vector<Rect> all;
    for (const Rect& rect : {at.top, at.tools, at.header, at.canvas, at.regions, at.selected, at.pages, at.sweep,
                             at.blurRange, at.seam, at.status}) {
        if (!rect.empty()) all.push_back(rect);
    }
    return all;
}
bool overlap(const Rect& a, const Rect& b) {
    return a.x < b.right() && b.x < a.right() && a.y < b.bottom() && b.y < a.bottom();
}
bool inside(const Rect& a, Size window) {
    return a.x >= 0 && a.y >= 0 && a.right() <= window.width && a.bottom() <= window.height;
}

}  // namespace

TEST_CASE("layout: panels lie inside the window and never overlap") {
    law("at any window size, scale and panel sizes", [] {
        const Size window{*rc::gen::inRange(300, 5000), *rc::gen::inRange(200, 3000)};
        const double scale = *rc::gen::inRange(10, 30) / 10.0;
        PanelSizes sizes{*rc::gen::inRange(0, 2000) * 1.0, *rc::gen::inRange(0, 2000) * 1.0,
                         *rc::gen::inRange(0, 100) / 100.0, *rc::gen::arbitrary<bool>()};
        const auto panels = panelsOf(layout(window, scale, sizes, *rc::gen::arbitrary<bool>()));
        for (std::size_t i = 0; i < panels.size(); ++i) {
            RC_ASSERT(inside(panels[i], window));
            for (std::size_t j = 0; j < i; ++j)
                RC_ASSERT(!overlap(panels[i], panels[j]));
        }
    });
}

TEST_CASE("layout: the sizes the window must work at leave room for every panel") {
    struct Case {
        Size window;
        double scale;
    };
    for (const Case& c : {Case{{1280, 720}, 1.0}, Case{{1920, 1080}, 1.0}, Case{{2560, 1440}, 2.0}}) {
        const Layout at = layout(c.window, c.scale, {});
        CHECK(at.canvas.w >= 800 * c.scale);
        CHECK(at.canvas.h >= 380 * c.scale);
        CHECK(at.top.h >= kLiveTarget * c.scale);
        CHECK(at.regions.h >= 150 * c.scale);
        CHECK(at.pages.h >= 200 * c.scale);
        CHECK(at.sweep.h >= 150 * c.scale);
        CHECK(at.tools.h >= 430 * c.scale);
    }
    CHECK_FALSE(layout({1920, 1080}, 1.0, {}).selected.empty());
    CHECK(layout({1280, 720}, 1.0, {}).selected.empty());
}

TEST_CASE("layout: twice the scale in twice the window is twice every rectangle") {
    const Layout once = layout({1280, 720}, 1.0, {}), twice = layout({2560, 1440}, 2.0, {});
    const auto a = panelsOf(once), b = panelsOf(twice);
    REQUIRE(a.size() == b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        CHECK(b[i].x == doctest::Approx(2 * a[i].x).epsilon(0.01));
        CHECK(b[i].h == doctest::Approx(2 * a[i].h).epsilon(0.01));
    }
}

TEST_CASE("layout: one page has the places of tools, tabs and charts, the columns beside it go down to the status") {
    const Layout usual = layout({1280, 800}, 1.0, {}), page = layout({1280, 800}, 1.0, {}, true);
    CHECK(page.canvas == Rect{0, usual.top.bottom(), usual.header.right(), usual.status.y - usual.top.bottom()});
    for (const Rect& gone : {page.tools, page.header, page.sweep, page.blurRange, page.seam, page.chartSplitter})
        CHECK(gone.empty());
    CHECK(page.pages.bottom() == page.status.y);
    CHECK(page.top == usual.top);
}

TEST_CASE("layout: Tab leaves the picture, TAKE and SAFE LIGHT") {
    PanelSizes hidden;
    hidden.hidden = true;
    const Layout at = layout({1280, 720}, 1.0, hidden);
    CHECK(panelsOf(at).size() == 2);
    CHECK(at.canvas.w == 1280);
}

TEST_CASE("viewport: zooming about a point leaves that point where it is, and picture and window are inverse") {
    law("for any zoom", [] {
        const Viewport before = fitted({50, 60, 900, 500}, {1920, 1080});
        const Point<WidgetFrame> about{50.0 + *rc::gen::inRange(0, 900), 60.0 + *rc::gen::inRange(0, 500)};
        const double factor = std::pow(2.0, *rc::gen::inRange(-30, 30) / 10.0);
        const Viewport after = zoomedAbout(before, about, factor);
        const auto a = before.toPicture(about), b = after.toPicture(about);
        RC_ASSERT(std::abs(a.x - b.x) < 1e-6 && std::abs(a.y - b.y) < 1e-6);
        const auto back = after.toWindow(after.toPicture(about));
        RC_ASSERT(std::abs(back.x - about.x) < 1e-6 && std::abs(back.y - about.y) < 1e-6);
    });
}

TEST_CASE("layout text: what was kept is read again") {
    State state;
    state.panels.side = 400;
    state.panels.charts = 250;
    state.page = Page::rig;
    state.brush.radius = 12.5;
    state.hintsUsed = {Hint::brush, Hint::take};
    const State read = withLayout({}, layoutText(state));
    CHECK(read.panels == state.panels);
    CHECK(read.page == Page::rig);
    CHECK(read.brush == state.brush);
    CHECK(read.hintsUsed == state.hintsUsed);
}

TEST_CASE("layout text: a corrupt one gives the default") {
    const State fresh;
    const auto isDefault = [&](const State& state) {
        return state.panels == fresh.panels && state.brush == fresh.brush && state.hintsUsed.empty();
    };
    State changed;
    changed.panels.side = 400;
    const std::string good = layoutText(changed);
    CHECK(isDefault(withLayout({}, "")));
    CHECK(isDefault(withLayout({}, "\xff\xfe{not a layout}")));
    CHECK(isDefault(withLayout({}, good + "side nan\n")));
    CHECK(isDefault(withLayout({}, good + "side 1e9\n")));
    CHECK(isDefault(withLayout({}, good + "surprise 3\n")));
    CHECK(isDefault(withLayout({}, "illuminatedfocus-layout 99\nside 400\n")));
    law("any change of a byte is understood or gives the default", [&](std::uint8_t byte) {
        std::string text = good;
        text[*rc::gen::inRange<std::size_t>(0, text.size())] = static_cast<char>(byte);
        const State read = withLayout({}, text);
        RC_ASSERT(read.panels.side >= 100 && read.panels.side <= 4000 && read.brush.radius >= 0.5);
    });
}
