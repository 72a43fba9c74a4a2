#include "stock/octree/thin_films.h"

namespace kerf::octree {

void ThinFilms::add(std::span<const FilmSpot> spots, double face_mm2, std::span<CutFilm> films) {
  std::uint32_t report = 0;
  double most = 0;
  for (const FilmSpot& spot : spots) {
    if (spot.report != report) most = 0;
    report = spot.report;
    double& faces = faces_[spot.brick];
    const double before = faces;
    faces += spot.faces;
    if (faces < kLeastFaces) continue;
    const double told = before < kLeastFaces ? faces : spot.faces;
    CutFilm& film = films[report];
    film.area_mm2 += told * face_mm2;
    if (told <= most) continue;
    most = told;
    film.at_mm = spot.at_mm;
    film.thickness_mm = spot.thickness_mm;
  }
}

}  // namespace kerf::octree
