#include "book.h"

#include "materials.h"
#include "sdf.h"

namespace ilf::samples {
namespace {

constexpr float kPageWidth = 0.138f, kPageHeight = 0.196f;
constexpr int kPixelsWide = 828, kPixelsHigh = 1176;  // six a millimetre

/// Height of the paper above the desk at `x` metres from the spine: it dives into the fold and droops at the edge.
float pageHeight(float x) {
    const float s = std::fabs(x) / kPageWidth;
    return 0.005f + 0.0195f * std::sqrt(clamp01(1.0f - std::pow(1.0f - clamp01(s / 0.42f), 2.0f))) - 0.0085f * s * s;
}

std::vector<TypeLine> chapter(const std::string& running, const std::string& title) {
    std::vector<TypeLine> lines;
    lines.push_back({running, Face::serifItalic, 34.0f, 2.0f, TypeLine::Set::centre});
    if (!title.empty()) lines.push_back({title, Face::serifBold, 62.0f, 1.45f, TypeLine::Set::left});
    return lines;
}

void add(std::vector<TypeLine>& lines, const std::string& words, float size = 44.0f) {
    for (TypeLine& line : paragraph(words, 35, size, 1.36f))
        lines.push_back(std::move(line));
    lines.back().leading = 1.8f;
}

std::shared_ptr<TypePicture> printed(const std::vector<TypeLine>& lines, const char* number) {
    auto page = std::make_shared<TypePicture>(typeset(kPixelsWide, kPixelsHigh, 70.0f, 50.0f, lines));
    const TypePicture foot =
        typeset(kPixelsWide, 50, 0.0f, 0.0f, {{number, Face::serif, 36.0f, 1.0f, TypeLine::Set::centre}});
    for (int y = 0; y < foot.height; ++y)
        for (int x = 0; x < foot.width; ++x)
            page->mark(x, kPixelsHigh - 80 + y, foot.ink[std::size_t(y) * std::size_t(foot.width) + std::size_t(x)]);
    return page;
}

/// Two rays through a lens to a focus behind it, drawn between `top` and `top` + 330 pixels.
void drawLens(TypePicture& page, float top) {
    const float middle = top + 150.0f;
    page.stroke({70.0f, middle}, {758.0f, middle}, 2.5f);
    for (int side = -1; side <= 1; side += 2) {
        V2 last{300.0f, middle - 130.0f};
        for (int i = 1; i <= 24; ++i) {
            const float t = -1.0f + float(i) / 12.0f;
            const V2 next{300.0f + float(side) * 34.0f * (1.0f - t * t), middle + 130.0f * t};
            page.stroke(last, next, 4.5f);
            last = next;
        }
        const float edge = middle + float(side) * 95.0f;
        page.stroke({70.0f, edge}, {300.0f, edge}, 4.0f);
        page.stroke({300.0f, edge}, {600.0f, middle}, 4.0f);
        page.stroke({600.0f, middle}, {740.0f, middle - float(side) * 44.0f}, 4.0f);
    }
    page.stroke({690.0f, middle - 120.0f}, {690.0f, middle + 120.0f}, 6.0f);
    page.stroke({300.0f, top + 292.0f}, {600.0f, top + 292.0f}, 2.5f);
}

/// A small Greek front: steps, columns, gable.
void drawTemple(TypePicture& page, float top) {
    const float left = 150.0f, right = 678.0f;
    for (int i = 0; i < 3; ++i) {
        const float y = top + 270.0f + 18.0f * float(i), out = 16.0f * float(i);
        page.stroke({left - out, y}, {right + out, y}, 5.0f);
    }
    for (int i = 0; i < 6; ++i) {
        const float x = left + 34.0f + 92.0f * float(i);
        page.stroke({x - 14.0f, top + 266.0f}, {x - 10.0f, top + 132.0f}, 4.0f);
        page.stroke({x + 14.0f, top + 266.0f}, {x + 10.0f, top + 132.0f}, 4.0f);
        page.stroke({x, top + 262.0f}, {x, top + 136.0f}, 2.0f);
        page.stroke({x - 20.0f, top + 128.0f}, {x + 20.0f, top + 128.0f}, 7.0f);
    }
    page.stroke({left, top + 112.0f}, {right, top + 112.0f}, 5.0f);
    page.stroke({left, top + 90.0f}, {right, top + 90.0f}, 5.0f);
    page.stroke({left - 10.0f, top + 88.0f}, {414.0f, top}, 6.0f);
    page.stroke({right + 10.0f, top + 88.0f}, {414.0f, top}, 6.0f);
}

}  // namespace

Spread opticsChapter() {
    std::vector<TypeLine> left = chapter("ON SEEING SHARPLY", "3  The lens");
    add(left,
        "A lens bends light so that rays from one point meet again in one point. Where they meet the image is sharp.");
    add(left, "Move the screen a little and each point spreads into a small disc. The wider the opening, the larger "
              "the disc.");
    add(left,
        "The eye does the same with its pupil: in bright light it narrows, and more of the world is clear at once.");
    add(left, "At night it opens, and only what we look at is sharp.");
    std::vector<TypeLine> right = chapter("THE LENS", "");
    for (int i = 0; i < 5; ++i)
        right.push_back({"", Face::serif, 66.0f, 1.0f, TypeLine::Set::left});
    right.push_back({"Fig. 7  A screen behind the focus", Face::serifItalic, 38.0f, 1.75f, TypeLine::Set::centre});
    add(right, "We measure a lens by its power, one over the distance at which it gathers the light of the sun. A "
               "power of two dioptres gathers it at half a metre.");
    add(right, "Powers of thin lenses in contact simply add: two and one make three.");
    add(right, "A lens that changes its power sweeps its focus through the room.");
    auto figure = printed(right, "41");
    drawLens(*figure, 118.0f);
    return {printed(left, "40"), figure, {0.10f, 0.13f, 0.22f}};
}

Spread galleryChapter() {
    std::vector<TypeLine> left = chapter("ROOMS OF STONE", "");
    for (int i = 0; i < 5; ++i)
        left.push_back({"", Face::serif, 66.0f, 1.0f, TypeLine::Set::left});
    left.push_back({"The north front in spring", Face::serifItalic, 38.0f, 1.75f, TypeLine::Set::centre});
    add(left,
        "Six columns stand on three steps. From the road they seem to lean inward, as though the roof were heavy.");
    add(left, "Walk nearer and the lean is gone; what was heavy is now calm.");
    add(left, "The stone came over the water, block by block.");
    std::vector<TypeLine> right = chapter("ROOMS OF STONE", "Evening light");
    add(right, "Late in the day the sun enters low between the columns and finds the statue at the far wall.");
    add(right,
        "First the hands, then the folds of the cloak, last the face. For a few minutes she seems about to speak.");
    add(right, "The guards know the hour, and wait for it in silence with all who came.");
    add(right, "Then the light climbs the wall, and it is over.");
    auto figure = printed(left, "86");
    drawTemple(*figure, 120.0f);
    return {figure, printed(right, "87"), {0.28f, 0.07f, 0.05f}};
}

void addBook(std::vector<Object>& objects, const std::string& region, const Frame& frame, const Spread& spread) {
    const Frame f = frame;
    objects.push_back({region,
                       [f](V3 world) {
                           const V3 p = f.local(world);
                           const float outside =
                               box(p - V3{0.0f, 0.012f, 0.0f}, {kPageWidth, 0.016f, 0.5f * kPageHeight});
                           if (outside > 0.02f) return outside;
                           // The leaves fan out a little at the fore edge.
                           const float edge = kPageWidth - 0.20f * (p.y - 0.004f) * (p.y > 0.004f ? 1.0f : 0.0f);
                           const float leaves =
                               std::max({std::fabs(p.x) - edge, std::fabs(p.z) - 0.5f * kPageHeight, 0.0022f - p.y});
                           return 0.55f * std::max(p.y - pageHeight(p.x), leaves);
                       },
                       [f, spread](V3 world, V3 normal) {
                           const V3 p = f.local(world);
                           V3 paper = V3{0.70f, 0.665f, 0.575f} * (0.96f + 0.08f * fbm(p * 45.0f, 3));
                           if (std::fabs(p.y - pageHeight(p.x)) > 0.0012f || dot(normal, f.y) < 0.12f) {
                               const float leaf = std::sin(p.y * 7000.0f + 2.0f * noise(p * 70.0f));
                               return plain(paper * (0.72f + 0.14f * leaf));
                           }
                           const TypePicture& page = p.x < 0.0f ? *spread.left : *spread.right;
                           const float along = p.x < 0.0f ? 1.0f + p.x / kPageWidth : p.x / kPageWidth;
                           const float ink = page.at(along, 0.5f + p.z / kPageHeight);
                           return plain(mix(paper, {0.035f, 0.03f, 0.03f}, 0.95f * ink));
                       }});
    objects.push_back({region,
                       [f](V3 world) {
                           const V3 p = f.local(world);
                           return box(p - V3{0.0f, 0.0013f, 0.0f},
                                      {kPageWidth + 0.005f, 0.0013f, 0.5f * kPageHeight + 0.004f}, 0.0008f);
                       },
                       [f, spread](V3 world, V3) {
                           return cloth(V3{f.local(world).x, f.local(world).z, 0.0f}, spread.cover, 0.0006f);
                       }});
}

}  // namespace ilf::samples
