// Paraxial ray transfer matrices: the base from which the closed forms of the optics follow.
#pragma once

namespace ilf {

/// Height above the axis (metres) and slope (radians) of a paraxial ray.
struct Ray {
    double height = 0.0, slope = 0.0;
};

/// (height, slope) -> (a height + b slope, c height + d slope). Determinant 1 in air.
struct RayMatrix {
    double a = 1.0, b = 0.0, c = 0.0, d = 1.0;

    constexpr Ray operator*(const Ray& ray) const {
        return {a * ray.height + b * ray.slope, c * ray.height + d * ray.slope};
    }
    /// `*this` after `first`: light meets the right factor first.
    constexpr RayMatrix operator*(const RayMatrix& first) const {
        return {a * first.a + b * first.c, a * first.b + b * first.d, c * first.a + d * first.c,
                c * first.b + d * first.d};
    }
    constexpr double determinant() const { return a * d - b * c; }
};

/// T(d): free travel over `distance` metres.
constexpr RayMatrix travel(double distance) { return {1.0, distance, 0.0, 1.0}; }

/// R(P): a thin lens of `power` dioptres.
constexpr RayMatrix thinLens(double power) { return {1.0, 0.0, -power, 1.0}; }

/// Where the rays of an axial object point that `system` (object plane to last surface) sends out meet again, metres
/// behind the last surface: b + x d = 0. Infinite when they leave parallel (d = 0, b of either sign).
constexpr double imageDistance(const RayMatrix& system) { return -system.b / system.d; }

/// Lateral magnification of that image: height over object height.
constexpr double imageScale(const RayMatrix& system) { return system.a + imageDistance(system) * system.c; }

/// Object plane to entrance pupil behind the tunable lens: T(e) R(P) T(w). Its b is N = w + e - w e P.
constexpr RayMatrix objectToPupil(double distance, double power, double lensToPupil) {
    return travel(lensToPupil) * thinLens(power) * travel(distance);
}

/// Object plane to retina: T(r) R(P_e) T(e) R(P) T(w).
constexpr RayMatrix objectToRetina(double distance, double power, double lensToPupil, double eyePower, double retina) {
    return travel(retina) * thinLens(eyePower) * objectToPupil(distance, power, lensToPupil);
}

}  // namespace ilf
