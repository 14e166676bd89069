// When is an object blurred? Both meanings of the word, for lens powers of either sign.
#pragma once

#include "core/optics/eye.h"

namespace ilf {

/// On which side of the retina the image lies where it is blurred: its sign is that of the defocus.
enum class BlurSide : int {
    near = -1,  ///< image behind the retina: too near, or too little power (hyperopic)
    none = 0,   ///< sharp
    far = 1,    ///< image in front of it: too far, or too much power (myopic)
};

/// Blurred whatever the eye accommodates to: far where P > 1/w + K_f, near where P < 1/w + K_n, none on the borders and
/// between them (`inFocusWindow` is that interval). Positive powers blur young and old alike on the far side; negative
/// ones blur for good only beyond the near border, which for a young eye no lens reaches (A = 10 D, e = 20 mm: -10.6 D
/// at 0.5 m). With the far point between lens and eye everything is far-blurred. Precondition: e P < 1.
BlurSide blurredForGood(const EyeOptics& eye, Metre distance, Dioptre lens);

/// Powers through which an object at `distance` is sharp to an eye that holds an object at `attended` sharp through
/// `attendedLens`: |L''(w, P) - L''(g, P_0)| <= b, so [1/w + K(L_0 - b), 1/w + K(L_0 + b)] with L_0 = L''(g, P_0). Open
/// below (-infinity) where 1 + e (L_0 - b) <= 0, empty where 1 + e (L_0 + b) <= 0.
PowerWindow sharpWhileAttending(const EyeOptics& eye, Metre distance, Metre attended, Dioptre attendedLens);

/// Blurred to that eye, by the exact difference: |w g (P - P_0) + (w - g)| / (N N_0) > b. Here negative powers blur as
/// positive ones do. Precondition: e P < 1 for both powers.
BlurSide blurredWhileAttending(const EyeOptics& eye, Metre distance, Dioptre lens, Metre attended,
                               Dioptre attendedLens);

}  // namespace ilf
