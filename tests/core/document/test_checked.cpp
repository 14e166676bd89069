// Wearers and rigs as typed or read from files: what is refused, and why.
#include <limits>

#include "scenes.h"
#include "tests/support/law.h"

namespace ilf {

namespace {

template <class T, class Change>
std::string refusal(const Change& change) {
    T value;
    change(value);
    const auto ok = checked(value);
    return ok ? std::string() : ok.error().what;
}
template <class Change>
std::string wearer(const Change& change) {
    return refusal<Wearer>(change);
}
template <class Change>
std::string rig(const Change& change) {
    return refusal<Rig>(change);
}
const Metre kNoMetre = Metre::fromSi(std::numeric_limits<double>::quiet_NaN());

}  // namespace

TEST_CASE("wearer: the defaults are accepted, and so is a document made of them") {
    CHECK(checked(Wearer{}).has_value());
    CHECK(checked(Rig{}).has_value());
    CHECK(edited(twoRegions(), SetWearer{}).has_value());
    CHECK(edited(twoRegions(), SetRig{}).has_value());
}

TEST_CASE("wearer: each number has its range and its sentence") {
    CHECK(wearer([](Wearer& w) { w.pupil = 9.5_mm; }) == "The pupil must be from 1 to 9 mm, not 9.5.");
    CHECK(wearer([](Wearer& w) { w.pupil = kNoMetre; }) == "The pupil must be from 1 to 9 mm, not nan.");
    CHECK(wearer([](Wearer& w) { w.lensToPupil = 4.0_mm; }) ==
          "The way from lens to pupil must be from 5 to 60 mm, not 4.");
    CHECK(wearer([](Wearer& w) { w.ametropia = -21.0_D; }) ==
          "The prescription must be from -20 to 20 D, not -21: no tunable lens can correct more.");
    CHECK(wearer([](Wearer& w) { w.ageYears = 4.0; }) == "The age must be from 5 to 110 years, not 4.");
    CHECK(wearer([](Wearer& w) { w.measuredAccommodation = -1.0_D; }) ==
          "The measured accommodation must be from 0 to 25 D, not -1.");
    CHECK(wearer([](Wearer& w) { w.axes[0] = w.axes[1]; }) ==
          "The way between the eyes must be from 30 to 90 mm, not 0.");
    CHECK(wearer([](Wearer& w) { w.confusion = {CircleOfConfusion::Preset::typed, 0.0_m}; }) ==
          "The circle of confusion must be from 0.5 to 500 um, not 0.");
    CHECK(wearer([](Wearer& w) {
              w.ametropia = -20.0_D;
              w.lensToPupil = 55.0_mm;
          }) ==
          "With a prescription of -20 D and the lens 55 mm before the pupil, the eye's far point lies between lens "
          "and eye, so that everything is blurred already: bring the lens closer.");
    CHECK(wearer([](Wearer& w) { w.camera = CameraObserver{.fNumber = 0.0}; }) ==
          "The camera's f-number must be from 0.5 to 64, not 0.");
    CHECK(wearer([](Wearer& w) { w.camera = CameraObserver{.focusDistance = 10.0_mm}; }) ==
          "The camera must be focused farther away than its focal length of 24 mm, not at 10 mm.");
}

TEST_CASE("rig: light that would flicker visibly is refused with the reason") {
    CHECK(rig([](Rig& r) { r.slotRate = 1000.0_Hz; }) ==
          "The slot rate must be an integer multiple of the sweep rate of 60 Hz, not 1000 Hz: slots that drift against "
          "the sweep make light flicker visibly, as 1000 Hz over 60 Hz does at 20 Hz.");
    CHECK(
        rig([](Rig& r) { r.sweepRate = 20.0_Hz; }) ==
        "The sweep rate must be from 30 to 1000 Hz, not 20 Hz: light that pulses at 3 to 30 Hz can trigger seizures.");
    CHECK(rig([](Rig& r) { r.sweepRate = r.slotRate = 30.0_Hz; }) ==
          "The slots of one sweep must be from 2 to 1024, not 1.");
    CHECK(rig([](Rig& r) {
              r.slotRate = Hertz::fromSi(std::numeric_limits<double>::infinity());
          }).starts_with("The slot rate must be an integer multiple"));
}

TEST_CASE("rig: raster, delay, lens and registration have their ranges") {
    CHECK(rig([](Rig& r) { r.projector.width = 8193; }) ==
          "The projector's width must be from 1 to 8192 pixels, not 8193.");
    CHECK(rig([](Rig& r) { r.projectorDelay = -1.0_ms; }) == "The projector's delay must be from 0 to 100 ms, not -1.");
    CHECK(rig([](Rig& r) { r.lensMin = r.lensMax; }) ==
          "The lowest lens power, 10 D, must be below the highest, 10 D.");
    const std::string folds =
        "The registration of camera and projector folds the picture onto a line, so that there is "
        "no way back: register again.";
    using Map = Homography<ProjectorFrame, CameraFrame>;
    CHECK(rig([](Rig& r) { r.registration = registered(Map{{1, 2, 0, 2, 4, 0, 0, 0, 1}}); }) == folds);
    CHECK(rig([](Rig& r) {
              r.registration = registered(Map{{1, 0, std::numeric_limits<double>::quiet_NaN(), 0, 1, 0, 0, 0, 1}});
          }) == folds);
    CHECK(rig([](Rig& r) { r.registration = registered(Map{{0.5, 0, 4000, 0, 0.5, -3000, 0, 0, 1}}); }).empty());
}

TEST_CASE("wearer and rig: a lens that focuses before the pupil is refused, whichever is set last") {
    Rig strong;
    strong.lensMax = 20.0_D;
    Wearer far;
    far.lensToPupil = 50.0_mm;
    const std::string sentence = "With the lens 50 mm before the pupil its power must stay below 20 D, and the rig "
                                 "allows 20 D: beyond that the lens focuses in front of the eye.";
    const Document withRig = *edited(twoRegions(), SetRig{strong});
    const Document withWearer = *edited(twoRegions(), SetWearer{far});
    CHECK(edited(withRig, SetWearer{far}).error().what == sentence);
    CHECK(edited(withWearer, SetRig{strong}).error().what == sentence);
}

}  // namespace ilf
