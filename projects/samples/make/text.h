// Lines of type set into a small picture that materials look up: book pages, plaques, rulers, dials.
#pragma once

#include <string>
#include <vector>

#include "vec.h"

namespace ilf::samples {

enum class Face { serif, serifBold, serifItalic, sans };

struct TypeLine {
    std::string words;
    Face face = Face::serif;
    float size = 40.0f;     // pixels of the type picture, ascender to descender
    float leading = 1.25f;  // advance to the next line, in sizes
    enum class Set { left, centre, justified } set = Set::left;
};

/// Ink coverage 0..1, `width` x `height` pixels, row by row from the top.
struct TypePicture {
    int width = 0, height = 0;
    std::vector<float> ink;

    /// Bilinear; u to the right and v down, 0..1 across the picture; no ink outside.
    float at(float u, float v) const;
    /// Keeps the darker of what is there and `coverage`.
    void mark(int x, int y, float coverage);
    /// A straight stroke of `thickness` pixels.
    void stroke(V2 a, V2 b, float thickness);
};

/// Sets the lines under each other inside the margins. Type comes from Debian's fonts-dejavu-core; when that is not
/// installed the lines are drawn as grey bars and the reason goes to standard error.
TypePicture typeset(int width, int height, float marginX, float marginTop, const std::vector<TypeLine>& lines);

/// `words` broken into lines for a column of `characters`, all but the last justified.
std::vector<TypeLine> paragraph(const std::string& words, std::size_t characters, float size, float leading = 1.25f);

}  // namespace ilf::samples
