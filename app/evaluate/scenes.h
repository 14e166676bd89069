// Scenes to evaluate: printed and painted surfaces made here, objects side by side, and how they are played.
#pragma once

#include <random>
#include <string>
#include <vector>

#include "core/compile/compile.h"

namespace ilf::app {

/// Lines of dark letter-like strokes on paper; `stroke` pixels wide.
Picture printedPage(Size size, int stroke, unsigned seed);
/// Soft patches of colour with fine brush marks.
Picture painting(Size size, unsigned seed);
/// Nothing but light shows on it.
Picture whiteSheet(Size size);

/// An upright strip of the picture, columns x0 to x1, as a region.
Region strip(std::string name, Size size, double x0, double x1, Look look, Metre distance);

/// A document over a picture with those regions, topmost first, on a projector whose raster is the picture.
Document scene(Picture picture, double focalPixels, std::vector<Region> regions, Look background,
               Metre backgroundDistance);

/// Planned and compiled.
Result<Compiled> played(const Document& document);

}  // namespace ilf::app
