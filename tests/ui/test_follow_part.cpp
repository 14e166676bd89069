// The Follows row: what is clicked becomes edits, and how it stands is said in words.
#include "ui/follow_part.h"

#include <doctest/doctest.h>

#include "tests/ui/headless.h"

using namespace ilf;
using namespace ilf::ui;
using namespace ilf::ui::test;
using When = EditRequest::When;

namespace {

const SetFollow* clicked(Desk& desk, const char* what, Requests& asked) {
    desk.state.selected = "Face";
    desk.settle();
    asked = desk.press(pageWindow(Page::selected), {"region", "follow", "###follows", what});
    return lastEdit<SetFollow>(asked, When::commit);
}

/// "marker" is clicked, and the app looks for three frames before it has found `markers`.
const SetFollow* lookedFor(Desk& desk, const std::vector<MarkerFound>& markers, Requests& asked) {
    desk.dress = [](View& view) { view.follow.looking = true; };
    CHECK(clicked(desk, "marker", asked) == nullptr);
    CHECK(std::ranges::any_of(asked, [](const Request& r) { return std::holds_alternative<LookForMarkers>(r); }));
    desk.settle();
    CHECK_FALSE(findRegion(desk.document(), "Face")->follow);
    desk.dress = [markers](View& view) {
        view.follow.looked = true;
        view.follow.markers = markers;
    };
    asked = desk.frame();
    return lastEdit<SetFollow>(asked, When::commit);
}

Region followingFace(Desk& desk, Follow follow) {
    Region face = *findRegion(desk.document(), "Face");
    face.follow = std::move(follow);
    return face;
}

FollowedNow nowOf(FollowState state) {
    FollowedNow now;
    now.region = "Face";
    now.state = state;
    now.confidence = 0.93;
    now.to = {{{30, 40}, {30, 40}, {30, 40}, {30, 40}}};
    return now;
}

}  // namespace

TEST_CASE("follows: a marker is asked for, and the one found nearest the region in the scene's picture is taken") {
    Desk desk(twoRegions());
    const auto middle = middleOf(findRegion(desk.document(), "Face")->mask);
    Requests asked;
    const auto* set = lookedFor(desk,
                                {{"6X6_250", 3, {middle.x + 50, middle.y}, true},
                                 {"APRILTAG_36h11", 7, {middle.x + 5, middle.y}, true},
                                 {"6X6_250", 9, middle, false}},
                                asked);
    REQUIRE(set != nullptr);
    REQUIRE(set->follow);
    CHECK(std::get<MarkerTarget>(set->follow->target) == MarkerTarget{"APRILTAG_36h11", 7});
    CHECK(findRegion(desk.document(), "Face")->follow == set->follow);
    CHECK(desk.state.toasts.back().text == "\"Face\" follows APRILTAG_36h11 number 7.");
    // Once: what is seen later changes nothing by itself.
    CHECK(lastEdit<SetFollow>(desk.frame(), When::commit) == nullptr);
}

TEST_CASE("follows: where no marker is seen that is said, and where one is seen live only, that it is to be grabbed") {
    for (const bool live : {false, true}) {
        Desk desk(twoRegions());
        Requests asked;
        std::vector<MarkerFound> markers;
        if (live) markers.push_back({"6X6_250", 3, {10, 10}, false});
        REQUIRE(lookedFor(desk, markers, asked) != nullptr);
        REQUIRE_FALSE(desk.state.toasts.empty());
        CHECK(desk.state.toasts.back().tone == Tone::warning);
        CHECK(desk.state.toasts.back().text.find(live ? "grab it (F5)" : "No marker is seen yet") != std::string::npos);
    }
}

TEST_CASE("follows: flat things are learnt where the region lies, poses by their number, and nothing again") {
    Desk desk(twoRegions());
    Requests asked;
    const auto* flat = clicked(desk, "flat", asked);
    REQUIRE(flat != nullptr);
    CHECK(std::get<PlanarTarget>(flat->follow->target).patch ==
          findRegion(desk.document(), "Face")->mask.coveredPixels());
    const auto* pose = clicked(desk, "pose", asked);
    REQUIRE(pose != nullptr);
    CHECK(std::get<StreamTarget>(pose->follow->target).address == "/pose/1");
    const auto* nothing = clicked(desk, "nothing", asked);
    REQUIRE(nothing != nullptr);
    CHECK_FALSE(nothing->follow);
    CHECK(desk.history.undoLabel() == label(SetFollow{}));
}

TEST_CASE("follows: what is blurred stays blurred when lost, all else goes neutral") {
    for (const Look look : {Look::focus, Look::blur, Look::neutral}) {
        Document document = twoRegions();
        document = *edited(document, SetLook{"Face", look});
        Desk desk(document);
        Requests asked;
        const auto* set = clicked(desk, "pose", asked);
        REQUIRE(set != nullptr);
        CHECK(set->follow->whenLost == (look == Look::blur ? Follow::WhenLost::blur : Follow::WhenLost::neutral));
    }
}

TEST_CASE("follows: its state is said in words, with what would help") {
    Desk desk(twoRegions());
    const Region face = followingFace(desk, {MarkerTarget{"APRILTAG_36h11", 7}, Follow::WhenLost::blur});
    FollowView view;
    CHECK(followWords(view, face).help.find("No live picture") != std::string::npos);
    view.camera = true;
    view.regions = {nowOf(FollowState::following)};
    CHECK(followWords(view, face).words == "following, 93 % sure");
    CHECK(followWords(view, face).help == "50 px from where it was painted.");
    view.regions = {nowOf(FollowState::holding)};
    CHECK(followWords(view, face).words == "not seen: stays");
    view.regions = {nowOf(FollowState::fading)};
    CHECK(followWords(view, face).words == "not seen: turns blurred");
    view.regions = {nowOf(FollowState::lost)};
    CHECK(followWords(view, face).words == "lost: blurred");
    view.regions[0].trouble = "It is not there.";
    CHECK(followWords(view, face).help == "It is not there.");
    CHECK(followWords({}, followingFace(desk, {StreamTarget{}})).help.find("--osc-port") != std::string::npos);
    CHECK(lossWords(face) == "Lost, it stays for 500 ms, then turns blurred within 500 ms.");
}
