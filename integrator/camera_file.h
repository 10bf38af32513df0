/* camera_file.h - a camera as the course's program saves it
 *
 * Thirty numbers, separated by white space:
 *   hFov vFov [deg] aspect near far
 *   position, target
 *   phi theta [rad] distance and its limits
 *   the rotation, row by row: x to the right, y up, z out of the scene
 *   width height [pixels] distance of the screen [pixels]
 *   focal distance, lens radius     (these two may be missing)
 */
#ifndef INTEGRATOR_CAMERA_FILE_H
#define INTEGRATOR_CAMERA_FILE_H

#include "bsdf/err.h"
#include "integrator/camera.h"

/** Reads one over a camera whose width and height are known; hFov spans the
 * width. */
bool camera_file_read(struct camera *c, const char *path, struct err *err);

#endif
