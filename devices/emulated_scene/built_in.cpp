#include "devices/emulated_scene/built_in.h"

namespace ilf::devices::scene {

SceneLens builtInCamera() {
    SceneLens lens;
    lens.size = {1280, 1024};
    lens.focalX = 2270.0;
    lens.focalY = 2268.0;
    lens.centreX = 648.3;
    lens.centreY = 505.9;
    lens.bend = {-0.11, 0.09, 0.0006, -0.0004, 0.0};
    return lens;
}

SceneLens builtInProjector(Size raster) {
    SceneLens lens;
    lens.size = raster;
    // 0.80 m wide at 1.1 m. A LightCrafter's mirrors stand in a diamond: its 912 columns are twice as far apart as its
    // 1140 rows.
    const bool diamond = raster == Size{912, 1140};
    lens.focalX = 1.1 * raster.width / 0.80;
    lens.focalY = diamond ? 2.0 * lens.focalX : lens.focalX;
    lens.centreX = 0.506 * raster.width;
    lens.centreY = 0.62 * raster.height;  // projectors throw upwards
    lens.bend = {0.04, -0.03, 0.0004, 0.0006, 0.0};
    return lens;
}

Placed builtInCameraAt() { return lookingAt({-0.08, -0.80, 0.74}, {0.0, 0.0, 0.03}, 1.2); }
Placed builtInProjectorAt() { return lookingAt({0.24, -0.78, 0.76}, {0.0, 0.03, 0.0}, -0.8); }

Stage builtInStage(Size raster, int board) {
    Stage stage;
    stage.camera = builtInCamera();
    stage.projector = builtInProjector(raster);
    stage.cameraAt = builtInCameraAt();
    stage.projectorAt = builtInProjectorAt();
    if (board == 0) {
        stage.things = deskThings();
    } else {
        Look wood;
        wood.colour = {0.46F, 0.36F, 0.27F};
        const int desk = stage.things.addLook(wood);
        stage.things.addSheet({-0.70, -0.55, -0.002}, {1.40, 0, 0}, {0, 1.20, 0}, desk);
        addBoard(stage.things, boardPose(board));
    }
    return stage;
}

}  // namespace ilf::devices::scene
