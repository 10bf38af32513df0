/* meshfile.h - meshes from PLY and OBJ files, by assimp
 *
 * What a file claims is checked against its size before anything is allocated.
 */
#ifndef INTEGRATOR_MESHFILE_H
#define INTEGRATOR_MESHFILE_H

#include "integrator/mesh.h"

struct meshfile_options {
    struct affine to_world;
    bool face_normals; /* flat, whatever the file has; else the file's normals,
                          or where it has none the vertices' by area */
    bool flip_normals; /* turns the triangles around */
};

/** Reads NAME.ply or NAME.obj, the latter without its materials.  NULL
 * and the reason; owned by the caller. */
struct mesh *meshfile_read(const char *path,
                           const struct meshfile_options *options,
                           struct err *err);

#endif
