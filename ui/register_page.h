// The wizard that registers a camera with the projector: scan, or corners, point pairs and a chessboard by hand.
#pragma once

#include "ui/panel.h"
#include "ui/register_view.h"
#include "ui/viewport.h"

namespace ilf::ui {

/// In place of tools, picture and charts while `View::registering` is set; top bar and Rig stay beside it.
void registerPage(Panel& p);
/// Rig's card: what the rig's registration is worth, and the button that leads to the page.
void registerCard(Panel& p);

/// Over the picture's upper edge while `View::bump` is set, with what can be done about it.
void bumpBanner(Panel& p);

/// The camera's picture with what the operator drags and clicks on it.
void registerPicture(Panel& p, const RegisterView& r, const Rect& area);
/// Where the page has its picture, as large as it can be.
Rect registerPictureArea(const Layout& at, double scale);
/// There is room beneath it for what its colours mean; else that stands in the column.
bool registerLegendBelow(const Layout& at, double scale);
/// How the camera's picture lies there.
Viewport registerViewport(const RegisterView& r, const Rect& area);

/// "scan", "four corners", ...
std::string word(RegisterWay way);

}  // namespace ilf::ui
