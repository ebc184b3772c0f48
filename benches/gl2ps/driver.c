/* Draws triangles with gl2ps, for the bench `peers`: reads a view and triangles, writes an SVG file,
   and prints the processor time of one page in seconds.

   driver bsp|simple FILE.svg < INPUT

   INPUT: the width and height in pixels; the six numbers of glFrustum; then the corners of triangles,
   three coordinates each, as the camera sees them. The number of a triangle is its colour:
   the upper seven bits of each byte. */

#include <GL/osmesa.h>
#include <gl2ps.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* The page is made repeatedly for this many seconds, and its mean time counts. */
#define ENOUGH 1.0

typedef struct {
    double corners[3][3];
} Triangle;

/* The processor time of this program. */
static double ran(void) {
    struct timespec time;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

static int read_triangle(Triangle *triangle) {
    double *numbers = &triangle->corners[0][0];
    int i;
    for (i = 0; i < 9; i++) {
        if (scanf("%lf", &numbers[i]) != 1) return 0;
    }
    return 1;
}

/* Seven bits of a number as a share of a colour, in the middle between two steps of its byte, because
   gl2ps rounds colours again where it cuts triangles. */
static float share(size_t number, int from) {
    return (float)(2 * ((number >> from) & 127) + 1) / 255.0f;
}

static void draw(const Triangle *triangles, size_t count) {
    size_t i;
    int corner;
    glBegin(GL_TRIANGLES);
    for (i = 0; i < count; i++) {
        glColor3f(share(i, 14), share(i, 7), share(i, 0));
        for (corner = 0; corner < 3; corner++) glVertex3dv(triangles[i].corners[corner]);
    }
    glEnd();
}

/* Makes the page, from its beginning to the file, with memory for the triangles in OpenGL's buffer. */
static int page(const char *name, GLint sort, const Triangle *triangles, size_t count,
                GLint size[2]) {
    GLint viewport[4] = {0, 0, size[0], size[1]};
    GLint memory = (GLint)(64 * (count + 1000) * sizeof(GLfloat));
    GLint options = GL2PS_SILENT | GL2PS_BEST_ROOT | GL2PS_OCCLUSION_CULL;
    FILE *file = fopen(name, "wb");
    GLint result;
    if (!file) return GL2PS_ERROR;
    result = gl2psBeginPage("drawing", "driver", viewport, GL2PS_SVG, sort, options,
                            GL_RGBA, 0, NULL, 0, 0, 0, memory, file, name);
    if (result == GL2PS_SUCCESS) {
        draw(triangles, count);
        result = gl2psEndPage();
    }
    fclose(file);
    return result;
}

int main(int count_of_arguments, char **arguments) {
    GLint size[2];
    double frustum[6], begin;
    size_t count = 0, room = 1024;
    Triangle *triangles = malloc(room * sizeof(Triangle));
    OSMesaContext context = OSMesaCreateContextExt(OSMESA_RGBA, 24, 0, 0, NULL);
    GLint sort;
    void *pixels;
    int i, pages = 0;

    if (count_of_arguments != 3 || !context || scanf("%d %d", &size[0], &size[1]) != 2) return 1;
    sort = strcmp(arguments[1], "bsp") == 0 ? GL2PS_BSP_SORT : GL2PS_SIMPLE_SORT;
    for (i = 0; i < 6; i++) {
        if (scanf("%lf", &frustum[i]) != 1) return 1;
    }
    while (triangles && read_triangle(&triangles[count])) {
        if (++count == room) triangles = realloc(triangles, (room *= 2) * sizeof(Triangle));
    }
    pixels = calloc((size_t)size[0] * (size_t)size[1], 4);
    if (!triangles || !pixels) return 1;
    if (!OSMesaMakeCurrent(context, pixels, GL_UNSIGNED_BYTE, size[0], size[1])) return 1;
    glMatrixMode(GL_PROJECTION);
    glFrustum(frustum[0], frustum[1], frustum[2], frustum[3], frustum[4], frustum[5]);
    begin = ran();
    do {
        if (page(arguments[2], sort, triangles, count, size) != GL2PS_SUCCESS) return 1;
        pages++;
    } while (ran() - begin < ENOUGH);
    printf("%.9f\n", (ran() - begin) / pages);
    return 0;
}
