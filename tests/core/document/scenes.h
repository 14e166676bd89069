// Documents, brushes and edits for the laws of the document.
#pragma once

#include <rapidcheck.h>

#include "core/document/edit.h"

namespace ilf {

inline Scene sceneOf(Size size) {
    Scene scene;
    const auto count = static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height) * 3;
    scene.picture = Box<Picture>(Picture(size, 3, std::vector<std::uint16_t>(count, 30000)));
    return scene;
}

inline Region regionOf(const std::string& id, const std::string& name, Look look, Metre distance) {
    Region region;
    region.id = id;
    region.name = name;
    region.look = look;
    region.distance = ConstantDistance{distance, {}};
    return region;
}

/// 320 x 200, with "Face" (id a) above "Hands" (id b), nothing painted.
inline Document twoRegions() {
    Document document = newDocument(sceneOf({320, 200}));
    document = *edited(document, AddRegion{regionOf("b", "Hands", Look::blur, 0.5_m), 0});
    return *edited(document, AddRegion{regionOf("a", "Face", Look::focus, 1.0_m), 0});
}

inline Point<CameraFrame> anyPoint(int width = 320, int height = 200) {
    return {*rc::gen::inRange(-400, width * 10 + 400) / 10.0, *rc::gen::inRange(-400, height * 10 + 400) / 10.0};
}
inline Brush anyBrush() {
    return {*rc::gen::inRange(5, 600) / 10.0, *rc::gen::inRange(0, 11) / 10.0, *rc::gen::inRange(0, 11) / 10.0};
}
inline Dab anyDab() { return {anyPoint(), anyBrush()}; }
inline std::vector<Dab> anyDabs(int most = 8) {
    std::vector<Dab> dabs(static_cast<std::size_t>(*rc::gen::inRange(1, most + 1)));
    for (Dab& dab : dabs)
        dab = anyDab();
    return dabs;
}
inline PaintMode anyMode() { return *rc::gen::element(PaintMode::add, PaintMode::erase); }

/// A mask with soft and hard parts.
inline Mask anyMask(Size size = {320, 200}) {
    Mask mask(size, *rc::gen::element<std::uint8_t>(0, 0, 255));
    const int strokes = *rc::gen::inRange(1, 4);
    for (int i = 0; i < strokes; ++i)
        mask = painted(mask, anyDabs(4), anyMode());
    return mask;
}

/// Any edit of `twoRegions` and what becomes of it; some are refused.
inline Edit anyEdit() {
    const RegionId id = *rc::gen::element<RegionId>("a", "b", "c", "nobody", kBackgroundId);
    const bool on = *rc::gen::arbitrary<bool>();
    const double number = *rc::gen::element(-1.0, 0.0, 0.05, 0.3, 1.0, 2.5, 1e9);
    switch (*rc::gen::inRange(0, 20)) {
    case 0:
        return AddRegion{regionOf(id, "New", Look::blur, Metre::fromSi(number)), *rc::gen::inRange(-1, 4)};
    case 1:
        return RemoveRegion{id};
    case 2:
        return DuplicateRegion{id, *rc::gen::element<RegionId>("c", "d", "a")};
    case 3:
        return RenameRegion{id, *rc::gen::element<std::string>("  Hand ", "", "\xe9\xa1\x94")};
    case 4:
        return MoveRegion{id, *rc::gen::inRange(-1, 4)};
    case 5:
        return SetLook{id, *rc::gen::element(Look::focus, Look::blur, Look::neutral)};
    case 6:
        return SetStrength{id, Dioptre::fromSi(number)};
    case 7:
        return SetDistance{id, ConstantDistance{Metre::fromSi(number), 0.1_m}};
    case 8:
        return SetVisible{id, on};
    case 9:
        return SetLocked{id, on};
    case 10:
        return SetSolo{id, on};
    case 11:
        return Paint{id, anyDabs(3), anyMode(), on};
    case 12:
        return FillShape{id, Rectangle{anyPoint(), anyPoint()}, anyMode(), on};
    case 13:
        return FillShape{id, Ellipse{anyPoint(), anyPoint()}, anyMode(), on};
    case 14:
        return SetOutline{id, {{anyPoint(), anyPoint(), anyPoint()}}};
    case 15:
        return GrowMask{id, *rc::gen::inRange(-4, 5) * 1.0};
    case 16:
        return InvertMask{id};
    case 17:
        return SetAlpha{Dioptre::fromSi(number)};
    case 18:
        return SetSeam{{Blending::none, Metre::fromSi(0.01 * number)}};
    default:
        return SetScene{sceneOf({*rc::gen::element(320, 160, 333), 200})};
    }
}

}  // namespace ilf
