// node-ar-drone, unmodified: takes off, hovers and lands, while others fly in the same air.
const arDrone = require('ar-drone');

const client = arDrone.createClient({ ip: '127.0.0.1' });
client.config('general:navdata_demo', 'TRUE');
const fail = setTimeout(() => { console.error('no end within 45 s'); process.exit(1); }, 45000);
client.takeoff(() => {
  client.after(24000, function () {
    this.land(() => {
      clearTimeout(fail);
      console.log('has landed');
      process.exit(0);
    });
  });
});
