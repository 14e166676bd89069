// Glyphs of FontAwesome 4.7 that the window uses, as UTF-8 text.
#pragma once

namespace ilf::ui::icon {

inline constexpr unsigned short first = 0xf000, last = 0xf2e0;
inline constexpr const char *star = "\uf005", *check = "\uf00c", *cross = "\uf00d", *trash = "\uf1f8",
                            *camera = "\uf030", *video = "\uf03d", *lock = "\uf023", *unlock = "\uf09c",
                            *eye = "\uf06e", *eyeOff = "\uf070", *plus = "\uf067", *minus = "\uf068", *up = "\uf077",
                            *down = "\uf078", *warning = "\uf071", *clone = "\uf24d", *solo = "\uf192",
                            *soloOff = "\uf10c", *bulb = "\uf0eb", *folder = "\uf07b", *file = "\uf016",
                            *picture = "\uf03e", *brush = "\uf1fc", *eraser = "\uf12d", *pointer = "\uf245",
                            *magic = "\uf0d0", *objects = "\uf247", *shield = "\uf132", *question = "\uf059",
                            *info = "\uf05a", *history = "\uf1da", *levelUp = "\uf148", *expand = "\uf065",
                            *circle = "\uf111", *cube = "\uf1b2";

}  // namespace ilf::ui::icon
