// GLFW's key numbers for the keys that commands use, so that this layer needs no GLFW.
#pragma once

namespace ilf::ui::keys {

// Letters and digits are their upper-case ASCII codes.
inline constexpr int space = 32, apostrophe = 39, comma = 44, minus = 45, period = 46, slash = 47, digit0 = 48,
                     digit1 = 49, digit2 = 50, digit3 = 51, equal = 61, leftBracket = 91, backslash = 92,
                     rightBracket = 93, grave = 96;
inline constexpr int escape = 256, enter = 257, tab = 258, backspace = 259, insert = 260, del = 261, right = 262,
                     left = 263, down = 264, up = 265, pageUp = 266, pageDown = 267, home = 268, end = 269;
inline constexpr int f1 = 290;  ///< F2 is f1 + 1, and so on to F12
inline constexpr int kpEnter = 335;

constexpr int letter(char c) { return static_cast<int>(c); }
constexpr int f(int n) { return f1 + n - 1; }

}  // namespace ilf::ui::keys
