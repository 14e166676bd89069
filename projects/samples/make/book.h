// An open book: curved pages with type, the block of leaves under them, the boards of the cover.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "scene.h"
#include "text.h"

namespace ilf::samples {

/// What is printed on the two open pages.
struct Spread {
    std::shared_ptr<const TypePicture> left, right;
    V3 cover{0.2f, 0.05f, 0.05f};
};

Spread opticsChapter();
Spread galleryChapter();

/// `frame`: on the desk, y up, the reader at +z. Each page is 138 mm wide and 196 mm high.
void addBook(std::vector<Object>& objects, const std::string& region, const Frame& frame, const Spread& spread);

}  // namespace ilf::samples
