vs.1.1                          ; light of sky and ground at the vertex, by what is open of the sky there
; c0: world, view and projection, c10: axis of the sky, c20: one half, c21: sky, c22: ground, c15: 8, c32 to c95: 8 x 8 vertices, what is open
m4x4 oPos, v0, c0
mul r4.xy, v7.xy, c15.y         ; columns and rows up to here,
mad r4.x, r4.y, c15.x, r4.x     ; the number of the vertex
add r4.x, r4.x, c20.x
mov a0.x, r4.x                  ; rounded down
dp3 r0, v3, c10
mad r0, r0, c20, c20            ; the share of the sky
mov r1, c22
sub r2, c21, r1
mad r0, r0, r2, r1
mov r3, c[a0.x + 32]
mul oD0, r0, r3.x
