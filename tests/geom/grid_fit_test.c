// Surfaces fitted to grids of points: golden numbers of the reference (06b, 4), and identities.

#include "geom/surface/loft.h"
#include "tests/geom/surface_support.h"

static void check_fit(const CagVec3 *data, size_t r, size_t s, int p, int q, const CagVec3 *net,
                      size_t nu, size_t nv, double expected_rms, const char *id) {
  CagGridData g = {
      .points = data, .r = r, .s = s, .degree_u = p, .degree_v = q, .spacing = CAG_GRID_CHORD};
  CagSurface *fit = NULL;
  CagSurfaceNurbsView v;
  CagGridReport report;
  MUST(cag_surface_fit(&g, nu, nv, &fit, &report, err));
  double rms = report.rms, largest = report.largest;
  cag_grid_report_free(&report);
  assert_true(cag_surface_nurbs_view(fit, &v));
  for (size_t i = 0; i < nu * nv; i++) {
    const double *h = v.homogeneous + 4 * i;
    assert_point(cag_vec3(h[0], h[1], h[2]), net[i], 1e-9, id);
  }
  assert_near(rms, expected_rms, 1e-9, id);
  assert_true(largest >= rms);
  cag_surface_release(fit);
}

static void fits_of_the_reference(void **state) {
  (void)state;
  {
    static const CagVec3 D[] = {{0.0, 0.0, 0.0},
                                {0.0, 0.0, 4.0},
                                {0.0, 0.0, 8.0},
                                {0.0, 0.0, 12.0},
                                {5.0, 1.682941969615793, 0.0},
                                {5.0, 1.3226026545479173, 4.1},
                                {5.0, 0.39589118494217235, 8.2},
                                {5.0, -0.7003509767480293, 12.3},
                                {10.0, 1.8185948536513634, 0.0},
                                {10.0, 1.4292105279991245, 4.2},
                                {10.0, 0.42780184019425177, 8.4},
                                {10.0, -0.7568024953079282, 12.6},
                                {15.0, 0.2822400161197344, 0.0},
                                {15.0, 0.22180883314997976, 4.3},
                                {15.0, 0.06639345648100292, 8.6},
                                {15.0, -0.11745328985524196, 12.9}};
    static const CagVec3 N[] = {{0.0, 0.0, 0.0},
                                {0.0, 0.0, 4.0},
                                {0.0, 0.0, 8.0},
                                {0.0, 0.0, 12.0},
                                {4.593165082883418, 2.3701805252137964, 0.0},
                                {4.596130999237806, 2.4493889987245523, 4.251131088687554},
                                {5.236346864568618, 0.4836815922994334, 8.285782194539534},
                                {4.927647729905067, -1.0015716007500262, 12.295658863794303},
                                {10.340520942192851, 2.7011147417529164, 0.0},
                                {10.336529387541532, 2.7554433705592896, 4.459782880111796},
                                {9.802769414763066, 0.5050594037443482, 8.49948541224823},
                                {10.060281585088418, -1.1223698234274597, 12.603616895105304},
                                {15.0, 0.2822400161197344, 0.0},
                                {15.0, 0.29141944953655785, 4.303574012027719},
                                {15.0, 0.05831207614809516, 8.601678474431354},
                                {15.0, -0.11745328985524196, 12.9}};
    check_fit(D, 4, 4, 3, 3, N, 4, 4, 0.0, "bspline-surface.fit.exact");
  }
  {
    static const CagVec3 D[] = {{0.0, 0.0, 0.0},
                                {0.0, 0.0, 4.0},
                                {0.0, 0.0, 8.0},
                                {0.0, 0.0, 12.0},
                                {0.0, 0.0, 16.0},
                                {0.0, 0.0, 20.0},
                                {0.0, 0.0, 24.0},
                                {0.0, 0.0, 28.0},
                                {5.0, 0.831143709986104, 0.0},
                                {5.0, 0.7974496269707823, 4.1},
                                {5.0, 0.6990992550156329, 8.2},
                                {5.0, 0.5440667279736329, 12.3},
                                {5.0, 0.3449219029548497, 16.4},
                                {5.0, 0.11781121092094396, 20.5},
                                {5.0, -0.11885147717143457, 24.6},
                                {5.0, -0.3458778256267727, 28.7},
                                {10.0, 1.5119507302934647, 0.0},
                                {10.0, 1.4506571262999555, 4.2},
                                {10.0, 1.2717459284943338, 8.4},
                                {10.0, 0.9897230488598214, 12.6},
                                {10.0, 0.6274545747034718, 16.8},
                                {10.0, 0.2143128128728264, 21.0},
                                {10.0, -0.21620518274608844, 25.2},
                                {10.0, -0.629193513426767, 29.4},
                                {15.0, 1.9192771659333698, 0.0},
                                {15.0, 1.8414707849412648, 4.3},
                                {15.0, 1.614360092907359, 8.6},
                                {15.0, 1.2563589607883023, 12.9},
                                {15.0, 0.7964937042988591, 17.2},
                                {15.0, 0.2720496639688318, 21.5},
                                {15.0, -0.2744518469331848, 25.8},
                                {15.0, -0.7987011210603367, 30.1},
                                {20.0, 1.9794460977196429, 0.0},
                                {20.0, 1.8992005031978056, 4.4},
                                {20.0, 1.664969939172782, 8.8},
                                {20.0, 1.2957455475473763, 13.2},
                                {20.0, 0.8214636128731884, 17.6},
                                {20.0, 0.2805783631918326, 22.0},
                                {20.0, -0.2830558540822558, 26.4},
                                {20.0, -0.823740231681615, 30.8},
                                {25.0, 1.6815742115905006, 0.0},
                                {25.0, 1.613404170235436, 4.5},
                                {25.0, 1.4144211938944637, 9.0},
                                {25.0, 1.100758591026552, 13.5},
                                {25.0, 0.6978477609260784, 18.0},
                                {25.0, 0.23835624542501888, 22.5},
                                {25.0, -0.24046091743179157, 27.0},
                                {25.0, -0.699781788572642, 31.5},
                                {30.0, 1.0795403648012878, 0.0},
                                {30.0, 1.035776425746015, 4.6},
                                {30.0, 0.9080329378953044, 9.2},
                                {30.0, 0.7066671947775657, 13.8},
                                {30.0, 0.44800569681271885, 18.4},
                                {30.0, 0.15302041763319568, 23.0},
                                {30.0, -0.15437157916405042, 27.6},
                                {30.0, -0.449247307737004, 32.2},
                                {35.0, 0.2822400161197344, 0.0},
                                {35.0, 0.2707981698792773, 4.7},
                                {35.0, 0.2374003227530958, 9.4},
                                {35.0, 0.18475433337040675, 14.1},
                                {35.0, 0.1171286773639349, 18.8},
                                {35.0, 0.040006364326535766, 23.5},
                                {35.0, -0.04035961823410873, 28.2},
                                {35.0, -0.11745328985524196, 32.9}};
    static const CagVec3 N[] = {
        {0.002225658141647536, -0.03105773146828361, 0.00010411603332342009},
        {0.00208877064112348, -0.030997297137909028, 9.327471674954065},
        {-0.0012001818205871313, -0.005025534328134755, 18.663710492791814},
        {0.0003984499296513026, 0.012437935761802956, 28.000146791521114},
        {11.514565195612317, 2.4100146756282643, -0.0010300620813538585},
        {11.520604412340413, 2.4898178080583007, 9.938167691834389},
        {11.74918590962, 0.5013771769926103, 19.797482387385706},
        {11.639035448948395, -1.0109296437809159, 29.628708950251056},
        {23.456915379598307, 2.6942019197687097, -0.0020319480806419267},
        {23.452054251570612, 2.778313308767897, 10.528855261490238},
        {23.266284104322494, 0.5550519560972643, 20.885519370223275},
        {23.35578499460552, -1.1267915871579777, 31.267827845978392},
        {34.99986136295362, 0.2501241240377052, 8.390749476686335e-05},
        {34.999876090275336, 0.25965300186830914, 10.961894956366534},
        {35.00007484940663, 0.05395387135219839, 21.931122856756737},
        {34.999975664219704, -0.10532609766817319, 32.900072222542704}};
    check_fit(D, 8, 8, 3, 3, N, 4, 4, 0.025833144141275476, "bspline-surface.fig49.fit");
  }
  {
    static const CagVec3 D[] = {{0.0, 0.0, 0.0},
                                {0.0, 0.0, 4.0},
                                {0.0, 0.0, 8.0},
                                {0.0, 0.0, 12.0},
                                {0.0, 0.0, 16.0},
                                {0.0, 0.0, 20.0},
                                {5.0, 0.958851077208406, 0.0},
                                {5.0, 0.8831603262743115, 4.1},
                                {5.0, 0.6680379787558534, 8.2},
                                {5.0, 0.34744712321477755, 12.3},
                                {5.0, -0.02799799341256157, 16.4},
                                {5.0, -0.39902284250009795, 20.5},
                                {10.0, 1.682941969615793, 0.0},
                                {10.0, 1.5500922033834956, 4.2},
                                {10.0, 1.1725169616732565, 8.4},
                                {10.0, 0.609827073024529, 12.6},
                                {10.0, -0.04914110157357112, 16.8},
                                {10.0, -0.7003509767480293, 21.0},
                                {15.0, 1.994989973208109, 0.0},
                                {15.0, 1.8375074477488498, 4.3},
                                {15.0, 1.3899228994144113, 8.6},
                                {15.0, 0.7229000868951695, 12.9},
                                {15.0, -0.05825275421353757, 17.2},
                                {15.0, -0.8302087662938229, 21.5},
                                {20.0, 1.8185948536513634, 0.0},
                                {20.0, 1.675036783592656, 4.4},
                                {20.0, 1.2670272361231312, 8.8},
                                {20.0, 0.6589819474719428, 13.2},
                                {20.0, -0.05310210098620189, 17.6},
                                {20.0, -0.7568024953079282, 22.0},
                                {25.0, 1.196944288207913, 0.0},
                                {25.0, 1.1024586958628562, 4.5},
                                {25.0, 0.8339191163092202, 9.0},
                                {25.0, 0.4337220445086998, 13.5},
                                {25.0, -0.03495020143692711, 18.0},
                                {25.0, -0.49810457906089406, 22.5},
                                {30.0, 0.2822400161197344, 0.0},
                                {30.0, 0.25996026979463294, 4.6},
                                {30.0, 0.19663851287687112, 9.2},
                                {30.0, 0.10227185846460712, 13.8},
                                {30.0, -0.008241273645004276, 18.4},
                                {30.0, -0.11745328985524196, 23.0}};
    static const CagVec3 N[] = {
        {0.0009137225347967251, -0.0007963589115965527, 2.123916669175359e-06},
        {0.0007566193004746041, -0.0008651457806146883, 4.999904083373416},
        {-0.0002229368416993591, -0.00012100032562126055, 14.999894399494485},
        {0.00015626128843825336, 0.00039834909157906, 20.000017655893757},
        {4.926050880183867, 1.0741769400708767, -0.00010959534192680628},
        {4.93693987018654, 1.0669502851886914, 5.132602726143277},
        {5.017826620971192, 0.0977016428667908, 15.382281897338418},
        {4.987060437415175, -0.45431091731914675, 20.498600990023586},
        {14.981547271435817, 2.2680657836231033, -0.0010898513539895425},
        {14.984445471943069, 2.230346101828246, 5.465633952177217},
        {15.004444374636668, 0.18340261489054316, 16.177977573422105},
        {14.996801544583533, -0.9462466308523674, 21.49829531183958},
        {25.068146525793633, 1.34823781909901, -0.0003203523883529134},
        {25.057875814959804, 1.3349982632335744, 5.6490728636828695},
        {24.98358256883799, 0.11892186553099433, 16.88744930297163},
        {25.01187235165126, -0.5671134070113035, 22.5007443854168},
        {29.999139002299977, 0.28106461970274915, -1.4320125473058689e-05},
        {29.999293930385583, 0.27768602501309547, 5.751130821409092},
        {30.000209648302956, 0.024459121065273072, 17.250692649655658},
        {29.99985467900934, -0.11753328626313109, 22.999967896202143}};
    check_fit(D, 7, 6, 2, 2, N, 5, 4, 0.0071059171551162426, "bspline-surface.fit.biquadratic");
  }
}

static void interpolation_meets_every_point(void **state) {
  (void)state;
  CagVec3 data[7 * 6];
  for (int i = 0; i < 7; i++)
    for (int j = 0; j < 6; j++)
      data[6 * i + j] = cag_vec3(i + 0.1 * j, 2 * j - 0.05 * i, sin(0.7 * i) * cos(0.9 * j));
  CagGridData g = {
      .points = data, .r = 7, .s = 6, .degree_u = 3, .degree_v = 2, .spacing = CAG_GRID_UNIFORM};
  CagSurface *s = NULL;
  MUST(cag_surface_interpolate(&g, &s, err));
  for (int i = 0; i < 7; i++)
    for (int j = 0; j < 6; j++)
      assert_point(surface_at(s, i / 6.0, j / 5.0), data[6 * i + j], 1e-12, "uniform");
  assert_consistent(s);
  cag_surface_release(s);
  // With the mean chords, the corners and edges are still interpolated.
  g.spacing = CAG_GRID_CHORD;
  MUST(cag_surface_interpolate(&g, &s, err));
  assert_point(surface_at(s, 0, 0), data[0], 1e-12, "corner");
  assert_point(surface_at(s, 1, 1), data[41], 1e-12, "corner");
  cag_surface_release(s);
  g.degree_u = 7;
  MUST_FAIL(cag_surface_interpolate(&g, &s, err), "order-range");
  g.degree_u = 3;
  MUST_FAIL(cag_surface_fit(&g, 8, 4, &s, NULL, err), "fit-underdetermined");
  for (int i = 0; i < 42; i++) data[i] = cag_vec3(1, 2, 3);
  MUST(cag_surface_fit(&g, 4, 4, &s, NULL, err)); // a point: uniform parameters
  cag_surface_release(s);
}

// Wigley's hull y = 5 (1 - (x/50)^2) (1 - (z/6)^2). The control points are at x = -50, 0, 50. Their
// heights are those of 1 - s^2 over -1..1, which are 0, 2, 0, times those over 0..1, which are 1,
// 1, 0.
enum { STATIONS = 8, DEPTHS = 7 };
static void wigley(CagVec3 *data) {
  static const double x[STATIONS] = {-50, -41, -30, -12, 5, 22, 37, 50};
  for (int i = 0; i < STATIONS; i++)
    for (int j = 0; j < DEPTHS; j++) {
      const double s = x[i] / 50, t = (double)j / (DEPTHS - 1);
      data[DEPTHS * i + j] = cag_vec3(x[i], 5 * (1 - s * s) * (1 - t * t), -6 * t);
    }
}

static CagGridData hull_of(const CagVec3 *data, double *v, const double *planes) {
  for (int i = 0; i < STATIONS * DEPTHS; i++) v[i] = (double)(i % DEPTHS) / (DEPTHS - 1);
  return (CagGridData){.points = data,
                       .r = STATIONS,
                       .s = DEPTHS,
                       .degree_u = 2,
                       .degree_v = 2,
                       .parameters = {NULL, v},
                       .hold = CAG_GRID_HOLD_X,
                       .slack = 1e-9,
                       .lines = CAG_GRID_PLANES_U,
                       .planes = planes,
                       .plane_count = 3};
}

static void a_hull_in_its_stations_is_found_again(void **state) {
  (void)state;
  CagVec3 data[STATIONS * DEPTHS];
  double v[STATIONS * DEPTHS], planes[3] = {-50, 0, 50};
  wigley(data);
  CagGridData g = hull_of(data, v, planes);
  CagSurface *s = NULL;
  CagSurfaceNurbsView view;
  CagGridReport report;
  MUST(cag_surface_fit(&g, 3, 3, &s, &report, err));
  assert_true(cag_surface_nurbs_view(s, &view));
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      const double *h = view.homogeneous + 4 * (3 * i + j);
      assert_true(h[0] == planes[i]); // exactly, because it is not an unknown
      assert_near(h[1], i == 1 && j < 2 ? 10 : 0, 1e-12, "y");
      assert_near(h[2], -3 * j, 1e-12, "z");
    }
  // x = -50 + 100 u
  for (int i = 0; i < STATIONS * DEPTHS; i++) {
    assert_near(report.u[i], (data[i].x + 50) / 100, 1e-14, "u");
    assert_true(report.u[i] == report.u[i / DEPTHS * DEPTHS]);
  }
  assert_true(report.largest < 1e-12 && report.rounds == 1 && report.planes_along == 0);
  cag_grid_report_free(&report);
  cag_surface_release(s);
}

// Multiplying lengths by a power of two results in exactly the same fit in another unit.
static void a_fit_does_not_depend_on_the_unit(void **state) {
  (void)state;
  enum { R = 9, S = 7, N = R * S };
  double rms[3], u[3][N], plain_rms = 0;
  int rounds[3];
  for (int k = -1; k < 3; k++) {
    static const double units[] = {1, 1. / (1 << 24), 1 << 20};
    const double unit = k < 0 ? 1 : units[k];
    CagVec3 data[N];
    for (int i = 0; i < R; i++)
      for (int j = 0; j < S; j++)
        data[i * S + j] =
            cag_scaled(cag_vec3(i + 0.3 * sin(j), j * j / 4., sin(i) * cos(0.7 * j)), unit);
    CagGridData g = {.points = data,
                     .r = R,
                     .s = S,
                     .degree_u = 3,
                     .degree_v = 2,
                     .spacing = CAG_GRID_CHORD,
                     .corrections = k < 0 ? 0 : 8};
    CagSurface *s = NULL;
    CagGridReport report;
    MUST(cag_surface_fit(&g, 5, 4, &s, &report, err));
    if (k < 0) plain_rms = report.rms;
    else {
      rms[k] = report.rms / unit;
      rounds[k] = report.rounds;
      memcpy(u[k], report.u, sizeof u[k]);
    }
    cag_grid_report_free(&report);
    cag_surface_release(s);
  }
  assert_true(rounds[0] > 1 && rms[0] < plain_rms);
  for (int k = 1; k < 3; k++) {
    assert_int_equal(rounds[k], rounds[0]);
    assert_true(rms[k] == rms[0]);
    assert_memory_equal(u[k], u[0], sizeof u[0]);
  }
}

static void planes_that_cannot_hold_the_data_are_refused(void **state) {
  (void)state;
  CagVec3 data[STATIONS * DEPTHS];
  double v[STATIONS * DEPTHS], planes[3] = {-50, 0, 49};
  wigley(data);
  CagGridData g = hull_of(data, v, planes);
  CagSurface *s = NULL;
  MUST_FAIL(cag_surface_fit(&g, 3, 3, &s, NULL, err), "beyond-planes");
  planes[1] = -50;
  MUST_FAIL(cag_surface_fit(&g, 3, 3, &s, NULL, err), "planes-not-monotone");
  planes[1] = NAN;
  MUST_FAIL(cag_surface_fit(&g, 3, 3, &s, NULL, err), "not-finite");
  MUST_FAIL(cag_surface_fit(&g, 4, 3, &s, NULL, err), "plane-count");
  g.planes = NULL;
  g.closed[0] = true;
  MUST_FAIL(cag_surface_fit(&g, 3, 3, &s, NULL, err), "planes-closed");
  g.closed[0] = false;
  data[3 * DEPTHS].x = 6;
  MUST_FAIL(cag_surface_fit(&g, 3, 3, &s, NULL, err), "coordinate-turns");
}

// Without planes, the border is that of its own curves, and the fixed coordinate is within the
// slack.
static void parameters_move_to_the_coordinate(void **state) {
  (void)state;
  CagVec3 data[9 * 8];
  for (int i = 0; i < 9; i++)
    for (int j = 0; j < 8; j++)
      data[8 * i + j] = cag_vec3(i + 0.05 * j * j, j + 0.3 * sin(i), sin(0.4 * i) * cos(0.3 * j));
  CagGridData g = {.points = data,
                   .r = 9,
                   .s = 8,
                   .degree_u = 3,
                   .degree_v = 3,
                   .hold = CAG_GRID_HOLD_X,
                   .slack = 1e-11};
  CagSurface *s = NULL;
  CagGridReport report;
  MUST(cag_surface_fit(&g, 6, 5, &s, &report, err));
  double sum = 0;
  for (int i = 0; i < 72; i++) {
    CagVec3 off = cag_sub(surface_at(s, report.u[i], report.v[i]), data[i]);
    assert_true(fabs(off.x) <= 1e-11);
    sum += cag_dot(off, off);
    if (i >= 8) assert_true(report.u[i] > report.u[i - 8]);
  }
  assert_near(report.rms, sqrt(sum / 72), 1e-14, "rms");
  assert_true(report.rounds > 0 && report.rounds < 20 && report.planes == NULL);
  assert_point(surface_at(s, 0, 0), data[0], 1e-14, "corner");
  assert_point(surface_at(s, 3, 2), data[71], 1e-14, "corner");
  cag_grid_report_free(&report);
  cag_surface_release(s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(fits_of_the_reference),
      cmocka_unit_test(interpolation_meets_every_point),
      cmocka_unit_test(a_hull_in_its_stations_is_found_again),
      cmocka_unit_test(a_fit_does_not_depend_on_the_unit),
      cmocka_unit_test(planes_that_cannot_hold_the_data_are_refused),
      cmocka_unit_test(parameters_move_to_the_coordinate),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
