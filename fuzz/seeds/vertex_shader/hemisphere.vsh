vs.1.1                      // c0: world, c8: world, view and projection, c41: sky, c42: ground
def c40, 0.0, 1.0, 0.0, 0.5 // up, and one half

m4x4 oPos, v0, c8
m3x3 r0.xyz, v3, c0
dp3 r0.w, r0, r0            // the matrix may have scaled the normal
rsq r0.w, r0.w
mul r0.xyz, r0, r0.w
dp3 r1.x, r0, c40
mad r1.x, r1.x, c40.w, c40.w
mov r2, c42
sub r3, c41, r2
mad oD0, r1.x, r3, r2       // from the ground's colour to the sky's
