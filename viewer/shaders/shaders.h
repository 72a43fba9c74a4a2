// viewer/shaders/shaders.h - the GLSL 3.30 sources of this folder, compiled in under their file
// names.
#pragma once

namespace kerf::shaders {

extern const char* const part_vert;       ///< Mesh to clip space.
extern const char* const part_frag;       ///< Writes normal and coverage, no light.
extern const char* const part_face_frag;  ///< The same of the face of a section.
extern const char* const screen_vert;     ///< One triangle that covers the viewport.
extern const char* const resolve_frag;    ///< 2 x 2 samples to one pixel.
extern const char* const background_frag;
extern const char* const occlusion_frag;  ///< Ambient occlusion from the depth.
extern const char* const edges_frag;      ///< Sharp edges and silhouettes.
extern const char* const composite_frag;  ///< Light.
extern const char* const stroke_vert;     ///< Antialiased line with round ends, in pixels.
extern const char* const stroke_frag;
extern const char* const scene_vert;  ///< The window's own: one pass, lit at once.
extern const char* const scene_frag;
extern const char* const path_vert;  ///< Toolpath: colour by kind, past and future.
extern const char* const path_frag;
extern const char* const marker_vert;  ///< Outlines, axes, markers of findings.
extern const char* const marker_frag;
extern const char* const line_vert;  ///< Lines of more than a pixel, of both kinds.
extern const char* const line_frag;
extern const char* const section_frag;    ///< The cut face of a section.
extern const char* const glass_frag;      ///< The transparent workpiece over the rest.
extern const char* const body_frag;       ///< What stands around a part.
extern const char* const overlay_frag;    ///< One picture over another.
extern const char* const workpiece_frag;  ///< The workpiece as a picture with depth.
extern const char* const csg_solid_vert;  ///< Image-space CSG: faces lit flat.
extern const char* const csg_solid_frag;
extern const char* const csg_inside_frag;  ///< Marks what is left of a layer of the blank.
extern const char* const csg_layer_frag;   ///< Lays the layers over each other.

}  // namespace kerf::shaders
