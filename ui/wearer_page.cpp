// The wearer: pupil, lens, prescription, age, what counts as blurred; or a camera in the eye's place. And where it
// looks.
#include <array>

#include "core/optics/eye.h"
#include "ui/widgets.h"

namespace ilf::ui {

namespace {

template <class Put>
void field(Panel& p, const char* label, const char* id, double value, const FieldSpec& spec, Put put) {
    if (const auto change = numberRow(p, label, id, value, spec)) {
        Wearer next = p.document().wearer;
        put(next, change->value);
        p.edit(change->commits, SetWearer{std::move(next)});
    }
}

void confusion(Panel& p) {
    using Preset = CircleOfConfusion::Preset;
    constexpr std::array<const char*, 4> names{"1 arcmin", "depth of field", "Landolt", "typed"};
    const CircleOfConfusion& now = p.document().wearer.confusion;
    rowLabel(p, "Acceptable",
             "The circle of confusion on the retina that still counts as sharp. 1 arcmin reproduces the "
             "paper; Landolt is the blur that hides a 1 arcmin gap.");
    ImGui::SetNextItemWidth(-1);
    if (ImGui::BeginCombo("###confusion", names[static_cast<std::size_t>(now.preset)])) {
        for (std::size_t i = 0; i < names.size(); ++i) {
            if (!ImGui::Selectable(names[i], i == static_cast<std::size_t>(now.preset))) continue;
            Wearer next = p.document().wearer;
            next.confusion.preset = static_cast<Preset>(i);
            if (next.confusion.preset == Preset::typed && next.confusion.diameter <= 0.0_m) {
                next.confusion.diameter = eyeOptics(p.document().wearer).confusion;
            }
            p.commit(SetWearer{std::move(next)});
        }
        ImGui::EndCombo();
    }
    if (now.preset == Preset::typed) {
        field(p, "  diameter", "###diameter", now.diameter.si(), {Unit::millimetre, 1e-6, 1e-3, 1e-7, "On the retina."},
              [](Wearer& w, double v) { w.confusion.diameter = Metre::fromSi(v); });
    } else {
        derivedRow(p, "  diameter", formatted(eyeOptics(p.document().wearer).confusion.si(), Unit::millimetre));
    }
}

/// How perceived views are looked at: no edit, since the document says who wears the glasses, not where they look.
void seeing(Panel& p) {
    ImGui::Dummy({1, p.px(4)});
    heading("IN PERCEIVED VIEWS");
    ViewRequest& seen = p.state.seeing;
    rowLabel(p, "Focuses on", "What the eye accommodates to, as far as it can.");
    ImGui::SetNextItemWidth(-1);
    const Region* attended = seen.attending ? findRegion(p.document(), *seen.attending) : nullptr;
    constexpr const char* kNearest = "nearest in focus";
    if (ImGui::BeginCombo("###attending", attended != nullptr ? attended->name.c_str() : kNearest)) {
        if (ImGui::Selectable(kNearest, attended == nullptr)) seen.attending.reset();
        const auto offer = [&](const Region& region) {
            ImGui::PushID(region.id.c_str());
            if (ImGui::Selectable((region.name + "###region").c_str(), &region == attended)) seen.attending = region.id;
            ImGui::PopID();
        };
        for (const Region* region : activeRegions(p.document()))
            offer(*region);
        if (p.document().background) offer(*p.document().background);
        ImGui::EndCombo();
    }
    const auto onOff = [&](const char* label, const char* id, bool& on, const char* help) {
        rowLabel(p, label, help);
        if (const auto picked = choice(id, {"off", "on"}, on ? 1 : 0, ImGui::GetContentRegionAvail().x))
            on = *picked == 1;
    };
    rowLabel(p, "Gaze",
             "Where the eye is turned. To the side its pupil moves, and the centre of magnification with it: seams "
             "shift. \"follows\" shows every point as seen when looking at it.");
    if (const auto picked = choice("###gaze", {"ahead", "point", "follows"}, static_cast<int>(seen.gaze),
                                   ImGui::GetContentRegionAvail().x)) {
        p.state.placingGaze = *picked == static_cast<int>(Gaze::fixed);
        if (!p.state.placingGaze) seen.gaze = static_cast<Gaze>(*picked);
    }
    if (p.document().rig.primaries) {
        onOff("Colours", "###chromatic", seen.chromatic,
              "The eye focuses red behind and blue before green: each colour of the projector is blurred by its own "
              "amount.");
    } else {
        derivedRow(p, "Colours", "together", "The rig does not say which wavelengths its light has: see the Rig page.");
    }
    onOff("Lens rim", "###lensField", seen.lensField,
          "Beyond the lens's rim the scene is seen past it: sharp, in steady light.");
}

}  // namespace

void wearerPage(Panel& p) {
    const Wearer& w = p.document().wearer;
    const bool camera = w.camera.has_value();
    rowLabel(p, "Observer", "A person, or a camera behind one lens as in the paper's photographs.");
    if (const auto picked = choice("###observer", {"eye", "camera"}, camera ? 1 : 0, ImGui::GetContentRegionAvail().x);
        picked && (*picked == 1) != camera) {
        Wearer next = w;
        next.camera = *picked == 1 ? std::optional(CameraObserver{}) : std::nullopt;
        p.commit(SetWearer{std::move(next)});
    }
    if (camera) {
        field(p, "Focal length", "###focal", w.camera->focalLength.si(),
              {Unit::millimetre, 1e-3, 1.0, 1e-4, "Of the camera's lens."},
              [](Wearer& n, double v) { n.camera->focalLength = Metre::fromSi(v); });
        field(p, "f-number", "###fNumber", w.camera->fNumber,
              {Unit::number, 0.5, 64.0, 0.0, "Focal length over aperture."},
              [](Wearer& n, double v) { n.camera->fNumber = v; });
        field(p, "Focused at", "###focus", w.camera->focusDistance.si(),
              {Unit::metre, 0.05, 1000.0, 0.0, "From the wearer's lens, in focus while that lens is at 0 D."},
              [](Wearer& n, double v) { n.camera->focusDistance = Metre::fromSi(v); });
        field(p, "Pixel pitch", "###pitch", w.camera->pixelPitch.si(),
              {Unit::millimetre, 5e-7, 1e-4, 1e-8, "Its circle of confusion is two pixels."},
              [](Wearer& n, double v) { n.camera->pixelPitch = Metre::fromSi(v); });
    } else {
        field(p, "Pupil", "###pupil", w.pupil.si(),
              {Unit::millimetre, 1e-3, 9e-3, 2e-5, "Entrance pupil diameter. Larger in the dark."},
              [](Wearer& n, double v) { n.pupil = Metre::fromSi(v); });
        field(p, "Prescription", "###ametropia", w.ametropia.si(),
              {Unit::dioptre, -20.0, 20.0, 0.01,
               "Sphere at the eye: negative for a myope. The lens rests at this correction."},
              [](Wearer& n, double v) { n.ametropia = Dioptre::fromSi(v); });
        field(p, "Age", "###age", w.ageYears,
              {Unit::year, 4.0, 100.0, 0.2,
               "Gives the amplitude of accommodation (Hofstetter's mean) unless it was measured."},
              [](Wearer& n, double v) { n.ageYears = v; });
        const bool measured = w.measuredAccommodation.has_value();
        const Dioptre amplitude = measured ? *w.measuredAccommodation : accommodationAtAge(w.ageYears);
        field(p, measured ? "Accommodation *" : "Accommodation", "###accommodation", amplitude.si(),
              {Unit::dioptre, 0.0, 20.0, 0.01, "How far the eye can refocus; type it when it was measured."},
              [](Wearer& n, double v) { n.measuredAccommodation = Dioptre::fromSi(v); });
        if (measured) {
            rowLabel(p, "");
            if (ImGui::Button("by age again###byAge")) {
                Wearer next = w;
                next.measuredAccommodation.reset();
                p.commit(SetWearer{std::move(next)});
            }
        }
        confusion(p);
    }
    field(p, "Lens to pupil", "###lensToPupil", w.lensToPupil.si(),
          {Unit::millimetre, 0.0, 0.2, 1e-4, "From the tunable lens to the entrance pupil."},
          [](Wearer& n, double v) { n.lensToPupil = Metre::fromSi(v); });
    field(
        p, "Lens aperture", "###aperture", w.lensAperture.si(),
        {Unit::millimetre, 1e-3, 0.1, 1e-4, "Clear diameter: nothing seen outside it is blurred (the dashed circle)."},
        [](Wearer& n, double v) { n.lensAperture = Metre::fromSi(v); });
    field(p, "Eyes apart", "###eyes", w.eyeSpacing().si(),
          {Unit::millimetre, 0.0, 0.1, 1e-4, "Between the two lens axes; drag L and R on the picture to place them."},
          [](Wearer& n, double v) {
              const Metre middle = (n.axes[0].right + n.axes[1].right) * 0.5;
              n.axes[0].right = middle - Metre::fromSi(v * 0.5);
              n.axes[1].right = middle + Metre::fromSi(v * 0.5);
          });
    if (!camera) seeing(p);
}

}  // namespace ilf::ui
