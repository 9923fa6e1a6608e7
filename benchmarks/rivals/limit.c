/* The speed limit: the four-bar's fused formulas as a C compiler compiles them at its best.
 *
 * Links are 2 crank, 3 coupler, 4 rocker; r = D - B, u = C - B, v = C - D, det = u x v / 2, idet = 1 / (u x v).
 * Numbers of a design alone are computed once, in Constants. low, high and f2 = |r|^2 are stored as quarters, so that
 * no factor 2 is left in the loop, and one division serves both 1 / f2 and 1 / det.
 * Angles that cannot be assembled give NaN.
 */
#include <math.h>
#include <stdint.h>

/* A design as limit.py packs it: centres of gravity (x, y) along and across the link from its first pin. */
typedef struct {
    double a, b, c, d, m2, m3, m4, I2, I3, I4, x2, y2, x3, y3, x4, y4, omega2, alpha2, gx, gy, sign;
} Design;

typedef struct {
    double a, d, ad, low0, high0, gap, along_u, along_v, sign;   /* closing the loop */
    double omega2, radial, tangential, gx, gy;                   /* rates and accelerations */
    double P2x, P2y, P2r, P2t, M2, M2c, M2s;                     /* crank: force and moment that its pins supply */
    double m3, k3, l3, J3, m4gx, m4gy, k4, l4, J4;               /* coupler, rocker */
} Constants;

static Constants prepare(const Design *p)
{
    double a = p->a, b = p->b, c = p->c, d = p->d, gx = p->gx, gy = p->gy;
    double square = p->omega2 * p->omega2, alpha = p->alpha2, hx = p->m2 * p->x2, hy = p->m2 * p->y2;
    return (Constants){
        .a = a, .d = d, .ad = a * d, .sign = p->sign, .gap = (b - c) * (b - c) / 4,
        .low0 = (d - a - b + c) * (d - a + b - c) / 4, .high0 = (b + c - d - a) * (b + c + d + a) / 4,
        .along_u = b * (b - c) / 2, .along_v = c * (b - c) / 2,
        .omega2 = p->omega2, .radial = square * a, .tangential = alpha * a, .gx = gx, .gy = gy,
        .P2x = -p->m2 * gx, .P2y = -p->m2 * gy, .P2r = square * hx + alpha * hy, .P2t = alpha * hx - square * hy,
        .M2 = alpha * (p->I2 + hx * p->x2 + hy * p->y2), .M2c = hx * gy - hy * gx, .M2s = hy * gy + hx * gx,
        .m3 = p->m3, .k3 = p->m3 * p->x3 / b, .l3 = p->m3 * p->y3 / b,
        .J3 = p->I3 + p->m3 * (p->x3 * p->x3 + p->y3 * p->y3),
        .m4gx = p->m4 * gx, .m4gy = p->m4 * gy, .k4 = p->m4 * p->x4 / c, .l4 = p->m4 * p->y4 / c,
        .J4 = p->I4 + p->m4 * (p->x4 * p->x4 + p->y4 * p->y4),
    };
}

#define NUMBER double
#define ROOT sqrt
#define NINE Nine
#define SOLVE solve
#include "limit_formulas.h"
#undef NUMBER
#undef ROOT
#undef NINE
#undef SOLVE

/* The nine unknowns, in rows of n. Nothing aliases: without the simd pragma gcc 12 gives up on the nine rows. */
void store(int64_t n, const double *restrict cos2, const double *restrict sin2, const double *restrict sin_half2,
           const double *restrict cos_half2, const Design *design, double *restrict out)
{
    Constants k = prepare(design);
#pragma omp simd
    for (int64_t i = 0; i < n; i++) {
        Nine f = solve(k, cos2[i], sin2[i], sin_half2[i], cos_half2[i]);
        out[i] = f.F12x, out[n + i] = f.F12y, out[2 * n + i] = f.F32x, out[3 * n + i] = f.F32y;
        out[4 * n + i] = f.F43x, out[5 * n + i] = f.F43y, out[6 * n + i] = f.F14x, out[7 * n + i] = f.F14y;
        out[8 * n + i] = f.T12;
    }
}

/* The same with vectors of two registers written by hand, as one alone would wait for its own results. */
#if defined __AVX512F__
enum { WIDE = 16 };
#elif defined __AVX__
enum { WIDE = 8 };
#else
enum { WIDE = 4 };
#endif

typedef double Wide __attribute__((vector_size(8 * WIDE), aligned(8)));

static inline Wide roots(Wide x)
{
    Wide y;
    for (int l = 0; l < WIDE; l++) y[l] = sqrt(x[l]);
    return y;
}

#define NUMBER Wide
#define ROOT roots
#define NINE WideNine
#define SOLVE solve_wide
#include "limit_formulas.h"

/* As `store`; the last vector steps back over angles seen. n must be at least WIDE. */
void store_wide(int64_t n, const double *restrict cos2, const double *restrict sin2, const double *restrict sin_half2,
                const double *restrict cos_half2, const Design *design, double *restrict out)
{
    Constants k = prepare(design);
    for (int64_t start = 0; start < n; start += WIDE) {
        int64_t i = start + WIDE <= n ? start : n - WIDE;
        WideNine f = solve_wide(k, *(const Wide *)(cos2 + i), *(const Wide *)(sin2 + i),
                                *(const Wide *)(sin_half2 + i), *(const Wide *)(cos_half2 + i));
        Wide *row[9];
        for (int r = 0; r < 9; r++) row[r] = (Wide *)(out + r * n + i);
        *row[0] = f.F12x, *row[1] = f.F12y, *row[2] = f.F32x, *row[3] = f.F32y;
        *row[4] = f.F43x, *row[5] = f.F43y, *row[6] = f.F14x, *row[7] = f.F14y, *row[8] = f.T12;
    }
}

enum { LANES = 16, SIGNALS = 6 };

static inline void keep(double *best, double *at, double value, double sample)
{
    int better = value > *best;
    *at = better ? sample : *at;
    *best = better ? value : *best;
}

/* Grid peaks of every design: largest |F12|, |F32|, |F43|, |F14|, largest T12, smallest T12 (kept as -T12), and the
 * first sample each is at, -1 for none. Lanes run along the angles and keep their own best, forces as squares, to the
 * end of the turn. n must be at least LANES.
 */
void peaks(int64_t n_designs, int64_t n, const double *restrict cos2, const double *restrict sin2,
           const double *restrict sin_half2, const double *restrict cos_half2, const Design *designs,
           double *restrict value, double *restrict at)
{
    for (int64_t j = 0; j < n_designs; j++) {
        Constants k = prepare(designs + j);
        double best[SIGNALS][LANES], when[SIGNALS][LANES];
        for (int s = 0; s < SIGNALS; s++)
            for (int l = 0; l < LANES; l++) best[s][l] = -INFINITY, when[s][l] = -1;
        for (int64_t i = 0; i < n; i += LANES) {
            int64_t start = i + LANES <= n ? i : n - LANES;   /* the last block steps back over samples seen */
            double sample = (double)start;
#pragma omp simd
            for (int l = 0; l < LANES; l++) {
                Nine f = solve(k, cos2[start + l], sin2[start + l], sin_half2[start + l], cos_half2[start + l]);
                keep(&best[0][l], &when[0][l], f.F12x * f.F12x + f.F12y * f.F12y, sample);
                keep(&best[1][l], &when[1][l], f.F32x * f.F32x + f.F32y * f.F32y, sample);
                keep(&best[2][l], &when[2][l], f.F43x * f.F43x + f.F43y * f.F43y, sample);
                keep(&best[3][l], &when[3][l], f.F14x * f.F14x + f.F14y * f.F14y, sample);
                keep(&best[4][l], &when[4][l], f.T12, sample);
                keep(&best[5][l], &when[5][l], -f.T12, sample);
            }
        }
        for (int s = 0; s < SIGNALS; s++) {
            double top = -INFINITY, first = INFINITY;   /* selects, no branches: these are not predictable */
            for (int l = 0; l < LANES; l++) top = best[s][l] > top ? best[s][l] : top;
            for (int l = 0; l < LANES; l++) {
                double here = best[s][l] == top ? when[s][l] + l : INFINITY;
                first = here < first ? here : first;
            }
            int none = top == -INFINITY;
            value[SIGNALS * j + s] = none ? NAN : s < 4 ? sqrt(top) : s == 4 ? top : -top;
            at[SIGNALS * j + s] = none ? -1 : first;
        }
    }
}

#if defined __AVX512F__ || defined __AVX__ || defined __SSE2__
#include <immintrin.h>
#endif

/* The bytes that a long sweep of the nine moves, without its arithmetic: three rows of n are read, nine written past the
 * caches, for samples first ... last, in eights. out begins with a line of the cache, and n is a multiple of 8.
 */
void move(int64_t first, int64_t last, int64_t n, const double *restrict in, double *restrict out)
{
    for (int64_t i = first; i < last; i += 8)
        for (int64_t row = 0; row < 9; row++) {
            const double *from = in + row % 3 * n + i;
            double *to = out + row * n + i;
#if defined __AVX512F__
            _mm512_stream_pd(to, _mm512_load_pd(from));
#elif defined __AVX__
            for (int l = 0; l < 8; l += 4) _mm256_stream_pd(to + l, _mm256_load_pd(from + l));
#elif defined __SSE2__
            for (int l = 0; l < 8; l += 2) _mm_stream_pd(to + l, _mm_load_pd(from + l));
#else
            for (int l = 0; l < 8; l++) to[l] = from[l];
#endif
        }
}
