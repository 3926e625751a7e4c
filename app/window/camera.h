/* From where the window looks. 3-D: around a point, at a distance. 2-D: from the front, a part of the
   plane. */
#pragma once

typedef struct camera {
    int dimension;
    double up[3], side[3], front[3];    /* unit axes that yaw turns in                           */
    double target[3], distance;         /* m                                                     */
    double yaw, pitch;                  /* radians                                               */
    double angle;                       /* degrees, vertical                                     */
    double low[3], high[3];             /* m, 2-D: what is seen                                  */
} camera;

/* Looks at the box, or from eye to target if angle > 0. up: against gravity; zero: z, in 2-D unused. */
void camera_home(camera *c, int dimension, const double low[3], const double high[3], const double up[3],
                 const double eye[3], const double target[3], double angle);
void camera_eye(const camera *c, double eye[3]);
void camera_orbit(camera *c, double yaw, double pitch);
/* By pixels of a picture of that height: what lies at the target follows the mouse. */
void camera_pan(camera *c, double x, double y, int height);
void camera_zoom(camera *c, double factor);
/* Pixels (x right, y down) and depth (m) of a point, and pixels per metre there. 0: behind the eye. */
int camera_project(const camera *c, int width, int height, const double point[3], double pixel[3],
                   double *scale);
