// The scene of the reference tables: one surface at half a metre, a straight border, a camera with the pupil of an eye.
#pragma once

#include "core/compile/compile.h"
#include "tests/core/perceived/small_scene.h"

namespace ilf::test {

inline constexpr double kSeamPixelsPerMm = 4.0;

struct SeamScene {
    double power_D = 2.0;
    double radius_mm = 100.0;  ///< from the optical centre to the border
    double feather_mm = 10.0;
    bool blurredInside = true;
    Blending blending = Blending::closedForm;
    double axesApart_mm = 0.0;
    int height = 96;
};

/// Blurred on one side of the picture's middle, focused on the other.
inline Document seamDocument(const SeamScene& scene) {
    const Size size{640, scene.height};
    const Mask mask =
        maskOf(size, [&](int x, int) { return scene.blurredInside ? x < size.width / 2 : x >= size.width / 2; });
    Document d = document({region("strip", Look::blur, 0.5, mask)}, Look::focus, 0.5, size);
    d.wearer.camera = CameraObserver{16.0_mm, 4.0, 0.5_m, 8.4_um};
    const Metre axis = Metre::fromSi(-1e-3 * scene.radius_mm), half = Metre::fromSi(0.5e-3 * scene.axesApart_mm);
    d.wearer.axes = {LensAxis{axis - half, 0.0_m}, LensAxis{axis + half, 0.0_m}};
    d.scene.scale.focalPixels = 1e3 * kSeamPixelsPerMm * (0.5 + d.wearer.lensToPupil.si());
    d.seam = {scene.blending, Metre::fromSi(1e-3 * scene.feather_mm)};
    d.alpha = Dioptre::fromSi(scene.power_D) - *minimumBlurPower(eyeOptics(d.wearer), 0.5_m);
    return d;
}

inline Compiled seamCompiled(const SeamScene& scene) {
    const Document d = seamDocument(scene);
    return *compile(d, *plan(planInput(d)));
}

}  // namespace ilf::test
