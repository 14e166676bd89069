// Edits: what each does, and the sentence with which it refuses.
#include "core/document/edit.h"

#include <cmath>
#include <limits>

#include "scenes.h"
#include "tests/support/law.h"

namespace ilf {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The sentence with which `edit` is refused; empty when it is not.
std::string refusal(const Document& document, const Edit& edit) {
    const auto next = edited(document, edit);
    return next ? std::string() : next.error().what;
}
std::string refusal(const Edit& edit) { return refusal(twoRegions(), edit); }

Document after(const Document& document, const Edit& edit) {
    auto next = edited(document, edit);
    REQUIRE_MESSAGE(next.has_value(), next.error().what);
    return *next;
}

}  // namespace

TEST_CASE("edit: a refused edit leaves the document equal, and no edit touches its argument") {
    law("any edit", [] {
        const Document document = *edited(twoRegions(), Paint{"a", anyDabs(2)});
        const Document before = document;
        const auto next = edited(document, anyEdit());
        RC_ASSERT(document == before);
        if (!next) {
            RC_ASSERT(!next.error().what.empty());
            RC_ASSERT(next.error().what.back() == '.');
        }
    });
}

TEST_CASE("edit: regions are added on top of what lies at their index, with a blank mask of the picture's size") {
    const Document document = after(twoRegions(), AddRegion{regionOf("c", "  Base ", Look::blur, 1.3_m), 1});
    REQUIRE(document.regions.size() == 3);
    CHECK(document.regions[1]->name == "Base");
    CHECK(document.regions[1]->mask == Mask({320, 200}));
    CHECK(refusal(document, AddRegion{regionOf("c", "Again", Look::blur, 1.0_m), 0}) ==
          "There already is a region \"c\": each needs an id of its own.");
    CHECK(refusal(AddRegion{regionOf(kBackgroundId, "Again", Look::blur, 1.0_m), 0}) ==
          "There already is a region \"background\": each needs an id of its own.");
    Region other = regionOf("d", "D", Look::blur, 1.0_m);
    other.mask = Mask({10, 20});
    CHECK(refusal(AddRegion{other, 0}) == "The mask has 10 x 20 pixels and the picture 320 x 200: they must agree.");
}

TEST_CASE("edit: deleting, moving, duplicating and renaming keep order and identity") {
    const Document document = after(twoRegions(), Paint{"a", {{{50.0, 50.0}, {}}}});
    CHECK(after(document, RemoveRegion{"a"}).regions.size() == 1);
    CHECK(after(document, MoveRegion{"a", 1}).regions[1].same(document.regions[0]));
    CHECK(after(document, MoveRegion{"a", 99}).regions[1]->id == "a");
    const Document twice = after(document, DuplicateRegion{"a", "a2"});
    CHECK(twice.regions[0]->id == "a2");
    CHECK(twice.regions[0]->name == "Face copy");
    CHECK(twice.regions[0]->mask == twice.regions[1]->mask);
    CHECK(after(document, RenameRegion{"a", " \xe9\xa1\x94 "}).regions[0]->name == "\xe9\xa1\x94");
    CHECK(refusal(RenameRegion{"a", " \t"}) == "A name needs at least one letter.");
    CHECK(refusal(RenameRegion{"a", std::string(201, 'x')}) ==
          "A name can have at most 200 bytes, and this one has 201: shorten it.");
    CHECK(refusal(RenameRegion{"a", "x\ny"}) == "A name cannot hold line breaks, tabs or other control characters.");
    CHECK(refusal(RenameRegion{"a", "\xc0\xaf"}) == "A name must be UTF-8 text: type it again.");
    CHECK(refusal(RenameRegion{"a", "caf\xe9"}) == "A name must be UTF-8 text: type it again.");
}

TEST_CASE("edit: a region that is not there is said to be gone") {
    for (const Edit& edit : std::vector<Edit>{
             RemoveRegion{"x"}, DuplicateRegion{"x", "y"}, RenameRegion{"x", "n"}, MoveRegion{"x", 0}, SetLook{"x"},
             SetStrength{"x", {}}, SetDistance{"x", {}}, SetVisible{"x"}, SetLocked{"x"}, SetSolo{"x"}, Paint{"x", {}},
             FillShape{"x", Rectangle{}}, GrowMask{"x", 1.0}, InvertMask{"x"}, SetMask{"x", Mask({320, 200}), ""},
             SetOutline{"x", {{{0, 0}, {9, 0}, {0, 9}}}}}) {
        CAPTURE(label(edit));
        CHECK(refusal(edit) == "There is no region \"x\": it may have been deleted.");
    }
}

TEST_CASE("edit: a locked region is not changed, but can be hidden, moved, soloed and unlocked") {
    const Document locked = after(twoRegions(), SetLocked{"a", true});
    for (const Edit& edit : std::vector<Edit>{
             RemoveRegion{"a"}, RenameRegion{"a", "n"}, SetLook{"a", Look::blur}, SetStrength{"a", {}},
             SetDistance{"a", {}}, Paint{"a", {}}, FillShape{"a", Rectangle{}}, GrowMask{"a", 1.0}, InvertMask{"a"},
             SetMask{"a", Mask({320, 200}), ""}, SetOutline{"a", {{{0, 0}, {9, 0}, {0, 9}}}}}) {
        CAPTURE(label(edit));
        CHECK(refusal(locked, edit) == "\"Face\" is locked: unlock it to change it.");
    }
    for (const Edit& edit : std::vector<Edit>{SetVisible{"a", false}, MoveRegion{"a", 1}, SetSolo{"a", true},
                                              SetLocked{"a", false}, DuplicateRegion{"a", "c"}}) {
        CAPTURE(label(edit));
        CHECK(refusal(locked, edit).empty());
    }
    CHECK_FALSE(after(locked, DuplicateRegion{"a", "c"}).regions[0]->locked);
}

TEST_CASE("edit: the background has a look and a distance and nothing else to change") {
    const Document document = twoRegions();
    CHECK(after(document, SetLook{kBackgroundId, Look::blur}).background->look == Look::blur);
    CHECK(after(document, SetStrength{kBackgroundId, 1.0_D}).background->strength == 1.0_D);
    CHECK(*distanceAt(document, *after(document, SetDistance{kBackgroundId, ConstantDistance{3.0_m, {}}}).background,
                      {}) == 3.0_m);
    CHECK(refusal(Paint{kBackgroundId, {}}) ==
          "The background fills what no region covers and cannot be painted: paint a region.");
    CHECK(refusal(InvertMask{kBackgroundId}) ==
          "The background fills what no region covers and cannot be painted: paint a region.");
    CHECK(refusal(RemoveRegion{kBackgroundId}) == "The background cannot be deleted: give it another look instead.");
    CHECK(refusal(MoveRegion{kBackgroundId, 0}) == "The background lies under all regions and cannot be moved.");
    CHECK(refusal(SetVisible{kBackgroundId, false}) ==
          "The background is always there: it cannot be hidden, locked or soloed.");
}

TEST_CASE("edit: distances are in front of the lens and at most a kilometre away") {
    const auto constant = [](double metres, double tolerance = 0.0) {
        return SetDistance{"a", ConstantDistance{Metre::fromSi(metres), Metre::fromSi(tolerance)}};
    };
    CHECK(refusal(constant(1000.0)).empty());
    CHECK(refusal(constant(-0.5)) ==
          "The distance of \"Face\" must be more than 0 m and at most 1000 m from the wearer's lens, not -0.5 m.");
    CHECK(refusal(constant(0.0)) ==
          "The distance of \"Face\" must be more than 0 m and at most 1000 m from the wearer's lens, not 0 m.");
    CHECK(refusal(constant(1001.0)).ends_with("not 1001 m."));
    CHECK(refusal(constant(kNaN)).ends_with("not nan m."));
    CHECK(refusal(constant(kInfinity)).ends_with("not inf m."));
    CHECK(refusal(constant(0.5, 0.5)) ==
          "The tolerance of the distance of \"Face\" must be from 0 m to less than 0.5 m, so that the surface stays in "
          "front of the lens, not 0.5 m.");
    CHECK(refusal(SetDistance{"a", FromDepthMap{}}) ==
          "There is no depth map to read the distance of \"Face\" from: load one, or type the distance.");
}

TEST_CASE("edit: a plane needs three points that are not on one line, and ends before infinity inside the region") {
    PlaneDistance plane{{{{{0, 0}, 1.0_m}, {{100, 100}, 1.1_m}, {{200, 200}, 1.2_m}}}};
    CHECK(refusal(SetDistance{"a", plane}) ==
          "The three points that give the distance of \"Face\" are on one line: drag one of them aside.");
    plane.anchors[2].at = {200.0, 0.0};
    CHECK(refusal(SetDistance{"a", plane}).empty());
    plane.anchors[1].distance = -1.0_m;
    CHECK(refusal(SetDistance{"a", plane}).starts_with("Each point of the distance of \"Face\" must be more than 0 m"));
    plane.anchors[1] = {{kNaN, 0.0}, 1.0_m};
    CHECK(refusal(SetDistance{"a", plane}) ==
          "The distance of \"Face\" has a point that is nowhere in the picture: place it again.");

    // 2 D at the bottom, 0.5 D in the middle: the horizon is at a third of the height.
    const PlaneDistance steep{{{{{0, 200}, 0.5_m}, {{320, 200}, 0.5_m}, {{160, 100}, 2.0_m}}}};
    const Document painted = after(twoRegions(), FillShape{"a", Rectangle{{0, 90}, {320, 200}}});
    CHECK(refusal(painted, SetDistance{"a", steep}).empty());
    CHECK(refusal(after(painted, FillShape{"a", Rectangle{{0, 10}, {20, 200}}}), SetDistance{"a", steep})
              .starts_with("The plane of \"Face\" reaches infinity inside the region"));
}

TEST_CASE("edit: numbers out of range are refused with what was typed") {
    CHECK(refusal(SetStrength{"a", 0.0_D}) ==
          "The strength of a blur must be more than 0 D and at most 10 D, not 0 D.");
    CHECK(refusal(SetStrength{"a", 10.0_D}).empty());
    CHECK(refusal(SetStrength{"a", Dioptre::fromSi(kNaN)}).ends_with("not nan D."));
    CHECK(refusal(SetAlpha{-0.1_D}) == "Alpha must be from 0 to 5 D, not -0.1.");
    CHECK(refusal(SetSeam{{Blending::none, 201.0_mm}}) == "The feather must be from 0 to 200 mm, not 201.");
    CHECK(refusal(GrowMask{"a", kInfinity}) == "The way to grow must be from -1000 to 1000 px, not inf.");
    CHECK(refusal(Paint{"a", {{{0, 0}, {0.0, 1.0, 1.0}}}}) == "The brush's radius must be from 0.5 to 2000 px, not 0.");
    CHECK(refusal(Paint{"a", {{{0, 0}, {5.0, 1.5, 1.0}}}}) == "The brush's hardness must be from 0 to 1, not 1.5.");
    CHECK(refusal(Paint{"a", {{{0, 0}, {5.0, 1.0, kNaN}}}}) == "The brush's opacity must be from 0 to 1, not nan.");
    CHECK(refusal(Paint{"a", {{{kNaN, 0}, {}}}}) == "A brush stroke lies nowhere near the picture: draw it again.");
    CHECK(refusal(SetOutline{"a", {{{0, 0}, {1, 1}}}}) == "An outline needs at least three points.");
    CHECK(refusal(SetPixelScale{{kNaN, PixelScale::Source::typed}}) ==
          "The picture must span from 0.5 to 175 degrees across, and a focal length of nan px does not: type the field "
          "of view.");
    CHECK(refusal(SetPixelScale{{300.0, PixelScale::Source::typed}}).empty());
}

TEST_CASE("edit: painting dissolves an outline into pixels, and changes nothing when nothing changes") {
    const Document outlined = after(twoRegions(), SetOutline{"a", {{{10, 10}, {100, 10}, {50, 90}}}});
    CHECK(outlined.regions[0]->outline);
    CHECK(outlined.regions[0]->mask.at(50, 30) == 255);
    CHECK_FALSE(after(outlined, Paint{"a", {{{200, 100}, {}}}}).regions[0]->outline);
    const Document same = after(outlined, Paint{"a", {{{53, 30}, {3.0, 1.0, 1.0}}}});
    CHECK(same.regions[0].same(outlined.regions[0]));
}

TEST_CASE("edit: a picture of another size takes masks, outlines and anchors along") {
    Document document = after(twoRegions(), FillShape{"a", Rectangle{{40, 40}, {160, 100}}});
    document = after(document, SetOutline{"b", {{{0, 0}, {100, 0}, {100, 100}}}});
    document =
        after(document, SetDistance{"b", PlaneDistance{{{{{0, 0}, 1.0_m}, {{100, 0}, 1.0_m}, {{0, 100}, 0.9_m}}}}});
    CHECK(after(document, SetScene{sceneOf({320, 200})}).regions[0].same(document.regions[0]));

    const Document half = after(document, SetScene{sceneOf({160, 100})});
    CHECK(half.regions[0]->mask == rasterised(Rectangle{{20, 20}, {80, 50}}, {160, 100}));
    CHECK(half.regions[1]->outline->vertices[2] == Point<CameraFrame>{50.0, 50.0});
    CHECK(half.regions[1]->mask == rasterised(*half.regions[1]->outline, {160, 100}));
    CHECK(std::get<PlaneDistance>(half.regions[1]->distance).anchors[1].at == Point<CameraFrame>{50.0, 0.0});

    const Document twice = after(document, SetScene{sceneOf({640, 400})});
    CHECK(twice.regions[0]->mask.at(200, 140) == 255);
    CHECK(twice.regions[0]->mask.at(70, 140) == 0);
    CHECK(refusal(SetScene{}) == "The picture is empty: choose another file or camera.");
    Scene mismatched = sceneOf({64, 64});
    mismatched.depth = Box<DepthMap>(depthOf(Image<std::uint16_t>({2, 1}, 1, {1, 2}), 1.0_mm));
    CHECK(refusal(SetScene{mismatched}) == "The depth map has 2 x 1 pixels and the picture 64 x 64: they must agree.");
}

TEST_CASE("edit: every edit has words for the undo menu") {
    CHECK(label(Paint{}) == "Paint");
    CHECK(label(Paint{"a", {}, PaintMode::erase}) == "Erase");
    CHECK(label(SetMask{"a", {}, "Select object"}) == "Select object");
    law("any edit", [] { RC_ASSERT(!label(anyEdit()).empty()); });
}

TEST_CASE("edit: the depth map's scale is an edit of its own, refused without a map or out of range") {
    Scene scene;
    scene.picture = Box(Picture({4, 2}, 3, std::vector<std::uint16_t>(24)));
    Document document = newDocument(scene);
    const auto without = edited(document, SetDepthScale{2.0_mm});
    REQUIRE_FALSE(without);
    CHECK(without.error().what == "The scene has no depth map: load one before setting its scale.");
    scene.depth = Box(depthOf(Image<std::uint16_t>({4, 2}, 1, std::vector<std::uint16_t>(8, 500)), 1.0_mm));
    document = newDocument(scene);
    const auto scaled = edited(document, SetDepthScale{0.2_mm});
    REQUIRE(scaled);
    CHECK(scaled->scene.depth->step == 0.2_mm);
    CHECK(scaled->scene.depth->metres.at(1, 1) == doctest::Approx(0.1));
    CHECK(wholeSteps(*scaled->scene.depth) == wholeSteps(*document.scene.depth));
    CHECK(edited(*scaled, SetDepthScale{1.0_mm})->scene.depth == document.scene.depth);
    CHECK_FALSE(edited(document, SetDepthScale{0.0_m}));
    CHECK_FALSE(edited(document, SetDepthScale{Metre::fromSi(std::nan(""))}));
}

}  // namespace ilf
