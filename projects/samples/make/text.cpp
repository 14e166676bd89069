#include "text.h"

#include <fstream>
#include <iostream>
#include <iterator>
#include <map>
#include <sstream>

#include <stb/stb_truetype.h>

namespace ilf::samples {
namespace {

struct Font {
    std::vector<unsigned char> bytes;
    stbtt_fontinfo info{};
    bool ready = false;
};

const Font& fontOf(Face face) {
    static const auto load = [](const char* file) {
        Font font;
        std::ifstream in(std::string("/usr/share/fonts/truetype/dejavu/") + file, std::ios::binary);
        font.bytes.assign(std::istreambuf_iterator<char>(in), {});
        font.ready = !font.bytes.empty() && stbtt_InitFont(&font.info, font.bytes.data(), 0) != 0;
        if (!font.ready) std::cerr << "no type " << file << ": install fonts-dejavu for readable pages\n";
        return font;
    };
    static const std::map<Face, Font> fonts = [] {
        std::map<Face, Font> all;
        all[Face::serif] = load("DejaVuSerif.ttf");
        all[Face::serifBold] = load("DejaVuSerif-Bold.ttf");
        all[Face::serifItalic] = load("DejaVuSerif-Italic.ttf");
        all[Face::sans] = load("DejaVuSans.ttf");
        return all;
    }();
    return fonts.at(face);
}

float advanceOf(const Font& font, float scale, char c) {
    int advance = 0, bearing = 0;
    stbtt_GetCodepointHMetrics(&font.info, c, &advance, &bearing);
    return float(advance) * scale;
}

void drawGlyph(TypePicture& picture, const Font& font, float scale, char c, float x, float baseline) {
    int w = 0, h = 0, left = 0, top = 0;
    const float whole = std::floor(x);
    unsigned char* glyph =
        stbtt_GetCodepointBitmapSubpixel(&font.info, scale, scale, x - whole, 0.0f, c, &w, &h, &left, &top);
    for (int j = 0; j < h; ++j)
        for (int i = 0; i < w; ++i)
            picture.mark(int(whole) + left + i, int(baseline) + top + j, float(glyph[j * w + i]) / 255.0f);
    stbtt_FreeBitmap(glyph, nullptr);
}

}  // namespace

float TypePicture::at(float u, float v) const {
    const float x = u * float(width) - 0.5f, y = v * float(height) - 0.5f;
    if (!(x > -1.0f && y > -1.0f && x < float(width) && y < float(height))) return 0.0f;
    const float fx = std::floor(x), fy = std::floor(y);
    const auto pixel = [&](int i, int j) {
        const bool inside = i >= 0 && j >= 0 && i < width && j < height;
        return inside ? ink[std::size_t(j) * std::size_t(width) + std::size_t(i)] : 0.0f;
    };
    const int i = int(fx), j = int(fy);
    return mix(mix(pixel(i, j), pixel(i + 1, j), x - fx), mix(pixel(i, j + 1), pixel(i + 1, j + 1), x - fx), y - fy);
}

void TypePicture::mark(int x, int y, float coverage) {
    if (x < 0 || y < 0 || x >= width || y >= height) return;
    float& pixel = ink[std::size_t(y) * std::size_t(width) + std::size_t(x)];
    pixel = std::max(pixel, coverage);
}

void TypePicture::stroke(V2 a, V2 b, float thickness) {
    const float dx = b.x - a.x, dy = b.y - a.y, squared = std::max(dx * dx + dy * dy, 1e-6f), reach = thickness + 1.0f;
    for (int y = int(std::min(a.y, b.y) - reach); y <= int(std::max(a.y, b.y) + reach); ++y)
        for (int x = int(std::min(a.x, b.x) - reach); x <= int(std::max(a.x, b.x) + reach); ++x) {
            const float px = float(x) + 0.5f - a.x, py = float(y) + 0.5f - a.y;
            const float t = clamp01((px * dx + py * dy) / squared);
            mark(x, y, clamp01(0.5f * thickness + 0.5f - length(V2{px - t * dx, py - t * dy})));
        }
}

TypePicture typeset(int width, int height, float marginX, float marginTop, const std::vector<TypeLine>& lines) {
    TypePicture picture{width, height, std::vector<float>(std::size_t(width) * std::size_t(height))};
    const float column = float(width) - 2.0f * marginX;
    float top = marginTop;
    for (const TypeLine& line : lines) {
        const Font& font = fontOf(line.face);
        if (!font.ready) {
            picture.stroke({marginX, top + 0.6f * line.size}, {marginX + column, top + 0.6f * line.size},
                           line.words.empty() ? 0.0f : 0.3f * line.size);
            top += line.size * line.leading;
            continue;
        }
        const float scale = stbtt_ScaleForPixelHeight(&font.info, line.size);
        int ascent = 0, descent = 0, gap = 0;
        stbtt_GetFontVMetrics(&font.info, &ascent, &descent, &gap);
        float natural = 0.0f;
        for (const char c : line.words)
            natural += advanceOf(font, scale, c);
        const auto spaces = std::count(line.words.begin(), line.words.end(), ' ');
        const bool stretch = line.set == TypeLine::Set::justified && spaces > 0;
        const float extra = stretch ? (column - natural) / float(spaces) : 0.0f;
        float x = marginX + (line.set == TypeLine::Set::centre ? 0.5f * (column - natural) : 0.0f);
        for (const char c : line.words) {
            drawGlyph(picture, font, scale, c, x, top + float(ascent) * scale);
            x += advanceOf(font, scale, c) + (c == ' ' ? extra : 0.0f);
        }
        top += line.size * line.leading;
    }
    return picture;
}

std::vector<TypeLine> paragraph(const std::string& words, std::size_t characters, float size, float leading) {
    std::vector<TypeLine> lines;
    std::istringstream in(words);
    std::string line, word;
    const auto add = [&](TypeLine::Set set) { lines.push_back({line, Face::serif, size, leading, set}); };
    while (in >> word) {
        if (!line.empty() && line.size() + 1 + word.size() > characters) {
            add(TypeLine::Set::justified);
            line.clear();
        }
        line += (line.empty() ? "" : " ") + word;
    }
    add(TypeLine::Set::left);
    return lines;
}

}  // namespace ilf::samples
