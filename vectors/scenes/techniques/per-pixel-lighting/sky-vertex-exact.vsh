vs.1.1                          ; light of sky and ground at the vertex, by the exact integral
; c0: world, view and projection, c10: axis of the sky, c20: one half, c41: sky, c42: ground, c45: 0, 1, a tiny number
m4x4 oPos, v0, c0
dp3 r0.x, v3, c10               ; cos q
mad r1.x, -r0.x, r0.x, c45.y    ; its sine, squared
max r1.x, r1.x, c45.z
rsq r1.w, r1.x
mul r1.x, r1.x, r1.w            ; sin q
mul r1.x, r1.x, c20.x
sge r2.x, r0.x, c45.x           ; above the horizon?
add r3.x, r1.x, r1.x
sub r3.x, c45.y, r3.x           ; 1 - sin q
mad r0.x, r2.x, r3.x, r1.x
mov r1, c42
sub r2, c41, r1
mad oD0, r0.x, r2, r1
