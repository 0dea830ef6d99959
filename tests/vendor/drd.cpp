// Stand-in for Force Dimension's DRD library: the functions that open devices and let them find
// their zero.

extern "C" {

int stand_in_open(char which);
int stand_in_close(char which);
bool stand_in_initialised();
int stand_in_find_zero();

int drdOpenID(char which) { return stand_in_open(which); }
int drdClose(char which) { return stand_in_close(which); }
bool drdIsInitialized(char) { return stand_in_initialised(); }
int drdAutoInit(char) { return stand_in_find_zero(); }
int drdStop(bool, char) { return 0; }

}  // extern "C"
